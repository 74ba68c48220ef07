use std::marker::PhantomData;
use std::os::raw::c_void;
use std::ptr;
use std::slice;

use crate::error::{check, definition, sized, text_in, Result};
use crate::game::{Game, GameLibrary, Simulation};
use crate::log::Recorder;
use crate::sys::{self, lks_session_event};
use crate::transport::Transport;

definition!(
    /// Settings of a server.
    ServerDef, lks_server_def, lks_server_def_init
);
definition!(
    /// Settings of a client.
    ClientDef, lks_client_def, lks_client_def_init
);

impl ClientDef {
    pub fn set_name(&mut self, name: &str) {
        crate::error::put_text(name, &mut self.0.name);
    }
    pub fn set_build(&mut self, build: &str) {
        crate::error::put_text(build, &mut self.0.build);
    }
}

/// Something that happened in the last update: `raw.kind` is one of `sys::LKS_SESSION_…`.
#[derive(Clone)]
pub struct Event {
    pub raw: lks_session_event,
    /// For people; empty where there is none.
    pub text: String,
}

impl Event {
    /// The tick and the hash after it, of `LKS_SESSION_TICK`.
    pub fn tick(&self) -> Option<(u64, u64)> {
        (self.raw.kind == sys::LKS_SESSION_TICK).then(|| (self.raw.tick, self.raw.hash))
    }
}

/// Microseconds of a clock that never runs backwards.
pub fn now_us() -> i64 {
    unsafe { sys::lks_now_us() }
}

fn read_events(
    events: &mut Vec<Event>,
    list: impl Fn(*mut lks_session_event, usize, *mut usize) -> i32,
    text: impl Fn(usize, *mut std::os::raw::c_char, usize) -> i32,
) {
    let mut raw: Vec<lks_session_event> = vec![unsafe { std::mem::zeroed() }; 64];
    let mut count = 0;
    if list(raw.as_mut_ptr(), raw.len(), &mut count) == sys::LKS_BUFFER_TOO_SMALL {
        raw.resize(count, unsafe { std::mem::zeroed() });
        list(raw.as_mut_ptr(), raw.len(), &mut count);
    }
    events.clear();
    for (index, raw) in raw.into_iter().take(count).enumerate() {
        let mut line = [0; 512];
        if raw.kind != sys::LKS_SESSION_TICK {
            text(index, line.as_mut_ptr(), line.len());
        }
        events.push(Event { raw, text: text_in(&line) });
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ServerState {
    Lobby,
    Running,
    Finishing,
    Closing,
    Over,
}

/// The server's side of a match: seats the players, closes tick after tick, compares states.
pub struct Server<G: Game> {
    handle: *mut sys::lks_server,
    transport: Transport,
    simulation: Simulation<G>,
    events: Vec<Event>,
}

impl<G: Game> Drop for Server<G> {
    fn drop(&mut self) {
        unsafe { sys::lks_server_destroy(self.handle) }
    }
}

impl<G: Game> Server<G> {
    /// The simulation must stand at tick 0.
    pub fn new(def: &ServerDef, simulation: Simulation<G>, transport: Transport) -> Result<Self> {
        let mut handle = ptr::null_mut();
        check(unsafe { sys::lks_server_create(&def.0, simulation.as_ptr(), transport.as_ptr(), &mut handle) })?;
        Ok(Server { handle, transport, simulation, events: Vec::new() })
    }
    /// Does all that is due, and returns its events; call it at least once a tick.
    pub fn update(&mut self, now_us: i64) -> Result<&[Event]> {
        let server = self.handle;
        let done = check(unsafe { sys::lks_server_update(server, now_us) });
        read_events(
            &mut self.events,
            |out, capacity, count| unsafe { sys::lks_server_events(server, out, capacity, count) },
            |index, out, capacity| unsafe { sys::lks_server_event_text(server, index, out, capacity) },
        );
        done.map(|()| &self.events[..])
    }
    /// Gives a command of the server's own, 1 … 65536 bytes, from `sys::LKS_SERVER_SLOT`.
    pub fn send_command(&mut self, bytes: &[u8]) -> Result<()> {
        check(unsafe { sys::lks_server_send_command(self.handle, bytes.as_ptr().cast(), bytes.len()) })
    }
    /// From here on each tick is written to this log.
    pub fn record(&mut self, recorder: &Recorder<G>) -> Result<()> {
        check(unsafe { sys::lks_server_record(self.handle, recorder.as_ptr()) })
    }
    pub fn stop(&mut self) -> Result<()> {
        check(unsafe { sys::lks_server_stop(self.handle) })
    }
    pub fn pause(&mut self, paused: bool) -> Result<()> {
        check(unsafe { sys::lks_server_pause(self.handle, paused as u32) })
    }
    pub fn view(&self) -> sys::lks_server_view {
        let mut view = sized!(lks_server_view);
        unsafe { sys::lks_server_get(self.handle, &mut view) };
        view
    }
    pub fn state(&self) -> ServerState {
        match self.view().state {
            sys::LKS_SERVER_LOBBY => ServerState::Lobby,
            sys::LKS_SERVER_RUNNING => ServerState::Running,
            sys::LKS_SERVER_FINISHING => ServerState::Finishing,
            sys::LKS_SERVER_CLOSING => ServerState::Closing,
            _ => ServerState::Over,
        }
    }
    pub fn stats(&self, slot: u32) -> Result<sys::lks_session_stats> {
        let mut stats = sized!(lks_session_stats);
        check(unsafe { sys::lks_server_stats(self.handle, slot, &mut stats) })?;
        Ok(stats)
    }
    /// For reading.
    pub fn simulation(&self) -> &Simulation<G> {
        &self.simulation
    }
    pub fn transport(&self) -> &Transport {
        &self.transport
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ClientState {
    Connecting,
    Handshaking,
    Lobby,
    Joining,
    Running,
    Finished,
    Refused,
    Failed,
}

type Sampler = Box<dyn FnMut(u64, &mut [u8])>;

unsafe extern "C" fn sample(user: *mut c_void, tick: u64, out: *mut u8, bytes: usize) {
    let sampler = &mut *user.cast::<Sampler>();
    let done = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        sampler(tick, slice::from_raw_parts_mut(out, bytes));
    }));
    if done.is_err() {
        std::process::abort();
    }
}

/// The client's side of a match: sends inputs, steps the ticks that the server closed.
pub struct Client<G: Game> {
    handle: *mut sys::lks_client,
    transport: Transport,
    events: Vec<Event>,
    sampler: Option<Box<Sampler>>,
    game: PhantomData<G>,
}

impl<G: Game> Drop for Client<G> {
    fn drop(&mut self) {
        unsafe { sys::lks_client_destroy(self.handle) }
    }
}

impl<G: Game> Client<G> {
    pub fn new(def: &ClientDef, game: &GameLibrary<G>, transport: Transport) -> Result<Self> {
        let mut handle = ptr::null_mut();
        check(unsafe {
            sys::lks_client_create(&def.0, game.as_ptr(), transport.as_ptr(), transport.connection, &mut handle)
        })?;
        Ok(Client { handle, transport, events: Vec::new(), sampler: None, game: PhantomData })
    }
    /// The input of this player from here on.
    pub fn set_input(&mut self, input: &[u8]) -> Result<()> {
        check(unsafe { sys::lks_client_set_input(self.handle, input.as_ptr().cast(), input.len()) })
    }
    /// Gives a command, 1 … 65536 bytes; it comes back to everybody at a tick. Returns its number.
    pub fn send_command(&mut self, bytes: &[u8]) -> Result<u64> {
        let mut number = 0;
        check(unsafe {
            sys::lks_client_send_command(self.handle, bytes.as_ptr().cast(), bytes.len(), &mut number)
        })?;
        Ok(number)
    }
    /// Asks for the input of each tick, in order and once each.
    pub fn on_sample(&mut self, sampler: impl FnMut(u64, &mut [u8]) + 'static) -> Result<()> {
        let mut sampler: Box<Sampler> = Box::new(Box::new(sampler));
        let user: *mut Sampler = &mut *sampler;
        check(unsafe { sys::lks_client_on_sample(self.handle, Some(sample), user.cast()) })?;
        self.sampler = Some(sampler);
        Ok(())
    }
    /// Does all that is due, and returns its events; call it at least once a tick.
    pub fn update(&mut self, now_us: i64) -> Result<&[Event]> {
        let client = self.handle;
        check(unsafe { sys::lks_client_update(client, now_us) })?;
        read_events(
            &mut self.events,
            |out, capacity, count| unsafe { sys::lks_client_events(client, out, capacity, count) },
            |index, out, capacity| unsafe { sys::lks_client_event_text(client, index, out, capacity) },
        );
        Ok(&self.events)
    }
    pub fn view(&self) -> sys::lks_client_view {
        let mut view = sized!(lks_client_view);
        unsafe { sys::lks_client_get(self.handle, &mut view) };
        view
    }
    pub fn state(&self) -> ClientState {
        match self.view().state {
            sys::LKS_CLIENT_CONNECTING => ClientState::Connecting,
            sys::LKS_CLIENT_HANDSHAKING => ClientState::Handshaking,
            sys::LKS_CLIENT_LOBBY => ClientState::Lobby,
            sys::LKS_CLIENT_JOINING => ClientState::Joining,
            sys::LKS_CLIENT_RUNNING => ClientState::Running,
            sys::LKS_CLIENT_FINISHED => ClientState::Finished,
            sys::LKS_CLIENT_REFUSED => ClientState::Refused,
            _ => ClientState::Failed,
        }
    }
    /// The name that a slot's player gave; kept after it left.
    pub fn player_name(&self, slot: u32) -> Result<String> {
        let mut text = [0; 64];
        check(unsafe { sys::lks_client_player_name(self.handle, slot, text.as_mut_ptr(), text.len()) })?;
        Ok(text_in(&text))
    }
    /// Why it was refused or failed, for people.
    pub fn reason(&self) -> String {
        let mut text = [0; 512];
        unsafe { sys::lks_client_reason(self.handle, text.as_mut_ptr(), text.len()) };
        text_in(&text)
    }
    /// The match, for reading, once the server's offer was understood.
    pub fn simulation(&self) -> Option<SimulationView<'_, G>> {
        let mut simulation = ptr::null_mut();
        let status = unsafe { sys::lks_client_simulation(self.handle, &mut simulation) };
        (status == sys::LKS_OK)
            .then(|| SimulationView { simulation: Simulation::adopt(simulation), client: PhantomData })
    }
    pub fn stats(&self) -> sys::lks_session_stats {
        let mut stats = sized!(lks_session_stats);
        unsafe { sys::lks_client_stats(self.handle, &mut stats) };
        stats
    }
    pub fn transport(&self) -> &Transport {
        &self.transport
    }
    /// Calls the server again after the connection was lost.
    pub fn reconnect(&mut self) -> Result<()> {
        let mut connection = 0;
        check(unsafe { sys::lks_enet_connect_again(self.transport.as_ptr(), &mut connection) })?;
        check(unsafe { sys::lks_client_reconnect(self.handle, connection) })
    }
    pub fn leave(&mut self) -> Result<()> {
        check(unsafe { sys::lks_client_leave(self.handle) })
    }
}

/// The match of a client, until its next update.
pub struct SimulationView<'a, G: Game> {
    simulation: Simulation<G>,
    client: PhantomData<&'a Client<G>>,
}

impl<G: Game> std::ops::Deref for SimulationView<'_, G> {
    type Target = Simulation<G>;
    fn deref(&self) -> &Simulation<G> {
        &self.simulation
    }
}
