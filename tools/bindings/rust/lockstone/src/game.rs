use std::ffi::CString;
use std::marker::PhantomData;
use std::os::raw::{c_char, c_void};
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::ptr;
use std::slice;
use std::sync::Arc;

use crate::error::{check, put_text, Error, Result};
use crate::sys::{
    self, lockstone_game_difference, lockstone_game_hash, lockstone_game_info, lockstone_game_input,
    lockstone_game_request, lockstone_game_table,
};

/// Two peers must agree on all of this before they play.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Info {
    pub abi: u32,
    pub canary: u64,
    pub config_hash: u64,
    pub scene_hash: u64,
    pub tick_rate: u16,
    /// 1 … 64
    pub players: u8,
    /// Of one player, for one tick: 1 … 64.
    pub input_bytes: u8,
}

/// Where the input of a slot came from. Part of the tick: every peer sees the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    Received,
    /// Late: the last input was repeated.
    Repeated,
    /// Late: all zero.
    Neutral,
    /// Nobody sits in this slot; all zero.
    Absent,
}

/// One player's input for one tick. Any bytes are legal: they come from the network.
#[derive(Clone, Copy, Debug)]
pub struct Input<'a> {
    pub bytes: &'a [u8],
    pub origin: Origin,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Snapshot {
    /// For rollback: this process alone.
    Native = sys::LKS_NATIVE,
    /// For files and other machines: may come from anywhere.
    Canonical = sys::LKS_CANONICAL,
}

/// A match that a tool wants to start.
pub struct Request<'a> {
    pub scene: &'a str,
    pub seed: u64,
    /// 0: the usual number.
    pub players: u32,
}

/// A deterministic game. Only inputs, state and tick decide about a result; `step`, `save`, `load`
/// and `hash` allocate nothing. A panic in it ends the program.
pub trait Game: Sized + 'static {
    /// Written into each log, by which tools find the game again.
    const NAME: &'static str;
    const VERSION: &'static str = "";

    /// The match at tick 0. Unknown bytes are an error: they may come from a stranger.
    fn create(config: &[u8]) -> Result<Self>;
    fn info(&self) -> Info;
    /// Ticks stepped.
    fn tick(&self) -> u64;
    /// `inputs` has one entry for each slot.
    fn step(&mut self, inputs: &[Input<'_>]);
    /// A command of the next tick, of a slot or of the server (`sys::LKS_SERVER_SLOT`): right before `step`.
    fn command(&mut self, _slot: u32, _bytes: &[u8]) {}
    fn snapshot_bytes_max(&self, kind: Snapshot) -> usize;
    /// Writes the whole state; returns its bytes.
    fn save(&self, kind: Snapshot, out: &mut [u8]) -> usize;
    /// Replaces the whole state; on an error the old one is untouched. Native bytes are always
    /// those that `save` wrote in this process.
    fn load(&mut self, kind: Snapshot, bytes: &[u8]) -> Result<()>;
    /// Over everything that can change the future.
    fn hash(&self) -> u64;
    /// From here on remembers the last ticks, as `World::keep_history` does. A client that predicts asks for it.
    fn keep_history(&mut self, _ticks: u32) {}
    /// The next steps simulate in full.
    fn forget_history(&mut self) {}
    /// Hashes of all parts of the state, at most 8, always the same in the same order.
    fn part_hashes(&self) -> Vec<(&'static std::ffi::CStr, u64)> {
        Vec::new()
    }
    /// The first difference between two canonical snapshots, for people.
    fn describe(&self, _here: &[u8], _there: &[u8]) -> Option<String> {
        None
    }
    /// The configuration bytes of a match that a tool wants to start.
    fn configure(_request: &Request<'_>) -> Result<Vec<u8>> {
        Err(Error::new(sys::LKS_UNSUPPORTED_VERSION, "the game configures no matches"))
    }
}

// A panic must not cross the border to C.
fn guard<T>(body: impl FnOnce() -> T) -> T {
    catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(|_| std::process::abort())
}

/// A game behind a pointer of C.
struct Held<G> {
    game: G,
    input_bytes: usize,
}

unsafe fn game_of<'a, G>(held: *const c_void) -> &'a G {
    &(*held.cast::<Held<G>>()).game
}
unsafe fn game_mut<'a, G>(held: *mut c_void) -> &'a mut G {
    &mut (*held.cast::<Held<G>>()).game
}
unsafe fn bytes_of<'a>(bytes: *const u8, size: usize) -> &'a [u8] {
    if size == 0 {
        return &[];
    }
    slice::from_raw_parts(bytes, size)
}
fn kind_of(kind: u32) -> Snapshot {
    if kind == sys::LOCKSTONE_GAME_NATIVE {
        Snapshot::Native
    } else {
        Snapshot::Canonical
    }
}
fn status_of<T>(result: &Result<T>) -> i32 {
    result.as_ref().map_or_else(|error| error.status, |_| sys::LKS_OK)
}

unsafe extern "C" fn create<G: Game>(config: *const u8, bytes: usize, out: *mut *mut c_void) -> i32 {
    guard(|| {
        let made = G::create(bytes_of(config, bytes));
        let status = status_of(&made);
        if let Ok(game) = made {
            let input_bytes = usize::from(game.info().input_bytes);
            *out = Box::into_raw(Box::new(Held { game, input_bytes })).cast();
        }
        status
    })
}
unsafe extern "C" fn destroy<G: Game>(game: *mut c_void) {
    guard(|| drop(Box::from_raw(game.cast::<Held<G>>())))
}
unsafe extern "C" fn info<G: Game>(game: *const c_void, out: *mut lockstone_game_info) {
    guard(|| {
        let info = game_of::<G>(game).info();
        *out = lockstone_game_info {
            config_hash: info.config_hash,
            scene_hash: info.scene_hash,
            canary: info.canary,
            abi: info.abi,
            tick_rate: info.tick_rate,
            player_count: info.players,
            input_bytes: info.input_bytes,
        };
    })
}
unsafe extern "C" fn tick<G: Game>(game: *const c_void) -> u64 {
    guard(|| game_of::<G>(game).tick())
}
unsafe extern "C" fn step<G: Game>(game: *mut c_void, inputs: *const lockstone_game_input, count: usize) {
    guard(|| {
        let bytes = (*game.cast::<Held<G>>()).input_bytes;
        let game = game_mut::<G>(game);
        let mut list = [Input { bytes: &[], origin: Origin::Absent }; 16];
        for (to, from) in list.iter_mut().zip(slice::from_raw_parts(inputs, count)) {
            to.bytes = bytes_of(from.bytes, bytes);
            to.origin = match from.origin {
                0 => Origin::Received,
                1 => Origin::Repeated,
                2 => Origin::Neutral,
                _ => Origin::Absent,
            };
        }
        game.step(&list[..count.min(list.len())]);
    })
}
unsafe extern "C" fn snapshot_bytes_max<G: Game>(game: *const c_void, kind: u32) -> usize {
    guard(|| game_of::<G>(game).snapshot_bytes_max(kind_of(kind)))
}
unsafe extern "C" fn save<G: Game>(game: *const c_void, kind: u32, out: *mut u8, capacity: usize) -> usize {
    guard(|| game_of::<G>(game).save(kind_of(kind), slice::from_raw_parts_mut(out, capacity)))
}
unsafe extern "C" fn load<G: Game>(game: *mut c_void, kind: u32, bytes: *const u8, size: usize) -> i32 {
    guard(|| status_of(&game_mut::<G>(game).load(kind_of(kind), bytes_of(bytes, size))))
}
unsafe extern "C" fn hash<G: Game>(game: *const c_void) -> u64 {
    guard(|| game_of::<G>(game).hash())
}
unsafe extern "C" fn command<G: Game>(game: *mut c_void, slot: u32, bytes: *const u8, size: usize) {
    guard(|| game_mut::<G>(game).command(slot, bytes_of(bytes, size)))
}
unsafe extern "C" fn keep_history<G: Game>(game: *mut c_void, ticks: u32) {
    guard(|| game_mut::<G>(game).keep_history(ticks))
}
unsafe extern "C" fn forget_history<G: Game>(game: *mut c_void) {
    guard(|| game_mut::<G>(game).forget_history())
}
unsafe extern "C" fn part_hashes<G: Game>(game: *const c_void, out: *mut lockstone_game_hash) -> usize {
    guard(|| {
        let parts = game_of::<G>(game).part_hashes();
        let count = parts.len().min(sys::LOCKSTONE_GAME_MAX_PARTS as usize);
        for (i, (name, low)) in parts.into_iter().take(count).enumerate() {
            *out.add(i) = lockstone_game_hash { name: name.as_ptr(), low, high: 0 };
        }
        count
    })
}
unsafe extern "C" fn describe<G: Game>(
    game: *const c_void,
    here: *const u8,
    here_bytes: usize,
    there: *const u8,
    there_bytes: usize,
    out: *mut lockstone_game_difference,
) -> i32 {
    guard(|| {
        *out = std::mem::zeroed();
        let text = game_of::<G>(game).describe(bytes_of(here, here_bytes), bytes_of(there, there_bytes));
        let text = match text {
            Some(text) => text,
            None => return 0,
        };
        put_text("state", &mut (*out).store);
        put_text(&text, &mut (*out).field);
        1
    })
}
unsafe extern "C" fn configure<G: Game>(request: *const lockstone_game_request, out: *mut u8, size: *mut usize) -> i32 {
    guard(|| {
        let scene = std::ffi::CStr::from_ptr((*request).scene).to_string_lossy();
        let made = G::configure(&Request { scene: &scene, seed: (*request).seed, players: (*request).players });
        let config = match &made {
            Ok(config) => config,
            Err(error) => return error.status,
        };
        if config.len() > *size {
            return sys::LKS_CAPACITY_EXHAUSTED;
        }
        ptr::copy_nonoverlapping(config.as_ptr(), out, config.len());
        *size = config.len();
        sys::LKS_OK
    })
}

/// The functions of a game, as C has them. Kept for the rest of the program.
pub struct GameTable;

impl GameTable {
    pub fn of<G: Game>() -> *const lockstone_game_table {
        let text = |text: &str| -> *const c_char { CString::new(text).unwrap_or_default().into_raw() };
        let table = lockstone_game_table {
            abi: sys::LOCKSTONE_GAME_ABI,
            bytes: std::mem::size_of::<lockstone_game_table>() as u32,
            name: text(G::NAME),
            version: text(G::VERSION),
            build: ptr::null(),
            create: Some(create::<G>),
            destroy: Some(destroy::<G>),
            info: Some(info::<G>),
            tick: Some(tick::<G>),
            step: Some(step::<G>),
            snapshot_bytes_max: Some(snapshot_bytes_max::<G>),
            save: Some(save::<G>),
            load: Some(load::<G>),
            hash: Some(hash::<G>),
            part_hashes: Some(part_hashes::<G>),
            describe: Some(describe::<G>),
            configure: Some(configure::<G>),
            bot: None,
            step_traced: None,
            draw: None,
            scenes: ptr::null(),
            scene_count: 0,
            keep_history: Some(keep_history::<G>),
            forget_history: Some(forget_history::<G>),
            command: Some(command::<G>),
        };
        Box::into_raw(Box::new(table))
    }
}

/// Exports `lockstone_game` from a `cdylib`, for `lockstone --game libmygame.so …`.
#[macro_export]
macro_rules! export_game {
    ($game:ty) => {
        #[no_mangle]
        pub extern "C" fn lockstone_game() -> *const $crate::sys::lockstone_game_table {
            static TABLE: std::sync::atomic::AtomicPtr<$crate::sys::lockstone_game_table> =
                std::sync::atomic::AtomicPtr::new(std::ptr::null_mut());
            let made = TABLE.load(std::sync::atomic::Ordering::Acquire);
            if !made.is_null() {
                return made;
            }
            let table = $crate::GameTable::of::<$game>() as *mut _;
            TABLE.store(table, std::sync::atomic::Ordering::Release);
            table
        }
    };
}

struct GameHandle(*mut sys::lks_game);
unsafe impl Send for GameHandle {}
unsafe impl Sync for GameHandle {}
impl Drop for GameHandle {
    fn drop(&mut self) {
        unsafe { sys::lks_game_destroy(self.0) }
    }
}

/// A game as sessions and logs take it.
pub struct GameLibrary<G: Game> {
    handle: Arc<GameHandle>,
    game: PhantomData<fn() -> G>,
}

impl<G: Game> Clone for GameLibrary<G> {
    fn clone(&self) -> Self {
        GameLibrary { handle: self.handle.clone(), game: PhantomData }
    }
}

impl<G: Game> GameLibrary<G> {
    pub fn new() -> Result<Self> {
        let mut game = ptr::null_mut();
        check(unsafe { sys::lks_game_create(GameTable::of::<G>(), &mut game) })?;
        Ok(GameLibrary { handle: Arc::new(GameHandle(game)), game: PhantomData })
    }
    pub(crate) fn as_ptr(&self) -> *const sys::lks_game {
        self.handle.0
    }
    /// A match at tick 0.
    pub fn simulation(&self, config: &[u8]) -> Result<Simulation<G>> {
        let mut simulation = ptr::null_mut();
        check(unsafe {
            sys::lks_simulation_create(self.as_ptr(), config.as_ptr().cast(), config.len(), &mut simulation)
        })?;
        Ok(Simulation::adopt(simulation))
    }
}

/// A match of a game.
pub struct Simulation<G: Game> {
    handle: *mut sys::lks_simulation,
    game: PhantomData<G>,
}

impl<G: Game> Drop for Simulation<G> {
    fn drop(&mut self) {
        unsafe { sys::lks_simulation_destroy(self.handle) }
    }
}

impl<G: Game> Simulation<G> {
    pub(crate) fn adopt(handle: *mut sys::lks_simulation) -> Self {
        Simulation { handle, game: PhantomData }
    }
    pub(crate) fn as_ptr(&self) -> *mut sys::lks_simulation {
        self.handle
    }
    /// For reading, as to draw it.
    pub fn game(&self) -> &G {
        let mut game = ptr::null_mut();
        unsafe {
            sys::lks_simulation_match(self.handle, &mut game);
            game_of(game)
        }
    }
    pub fn tick(&self) -> u64 {
        self.game().tick()
    }
    pub fn hash(&self) -> u64 {
        self.game().hash()
    }
    /// `inputs`: the players' inputs one after another, all received.
    pub fn step(&mut self, inputs: &[u8]) -> Result<()> {
        check(unsafe { sys::lks_simulation_step(self.handle, inputs.as_ptr().cast(), inputs.len(), ptr::null()) })
    }
}
