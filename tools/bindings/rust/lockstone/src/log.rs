use std::marker::PhantomData;
use std::ptr;

use crate::error::{c_text, check, definition, sized, text_in, Result};
use crate::game::{Game, GameLibrary, Simulation};
use crate::sys;

definition!(
    /// Settings of a log to be written.
    RecorderDef, lks_recorder_def, lks_recorder_def_init
);

/// Writes the log of a match.
pub struct Recorder<G: Game> {
    handle: *mut sys::lks_recorder,
    game: PhantomData<G>,
}

impl<G: Game> Drop for Recorder<G> {
    fn drop(&mut self) {
        unsafe { sys::lks_recorder_destroy(self.handle) }
    }
}

impl<G: Game> Recorder<G> {
    pub fn to_file(def: &RecorderDef, simulation: &Simulation<G>, path: &str) -> Result<Self> {
        let path = c_text(path)?;
        let mut handle = ptr::null_mut();
        check(unsafe { sys::lks_recorder_create(&def.0, simulation.as_ptr(), path.as_ptr(), &mut handle) })?;
        Ok(Recorder { handle, game: PhantomData })
    }
    pub fn in_memory(def: &RecorderDef, simulation: &Simulation<G>) -> Result<Self> {
        let mut handle = ptr::null_mut();
        check(unsafe { sys::lks_recorder_create_in_memory(&def.0, simulation.as_ptr(), &mut handle) })?;
        Ok(Recorder { handle, game: PhantomData })
    }
    pub(crate) fn as_ptr(&self) -> *mut sys::lks_recorder {
        self.handle
    }
    /// Records the tick that the simulation was just stepped by.
    pub fn step(&mut self, inputs: &[u8]) -> Result<()> {
        check(unsafe { sys::lks_recorder_step(self.handle, inputs.as_ptr().cast(), inputs.len(), ptr::null()) })
    }
    pub fn finish(&mut self, reason: &str) -> Result<()> {
        let reason = c_text(reason)?;
        check(unsafe { sys::lks_recorder_finish(self.handle, reason.as_ptr()) })
    }
    /// The log so far of a recorder in memory.
    pub fn bytes(&self) -> Result<Vec<u8>> {
        let mut count = 0;
        let asked = unsafe { sys::lks_recorder_bytes(self.handle, ptr::null_mut(), 0, &mut count) };
        if asked != sys::LKS_BUFFER_TOO_SMALL {
            check(asked)?;
        }
        let mut bytes = vec![0; count];
        check(unsafe { sys::lks_recorder_bytes(self.handle, bytes.as_mut_ptr().cast(), bytes.len(), &mut count) })?;
        Ok(bytes)
    }
}

/// The verdict on a log: `raw.outcome` is one of `sys::LKS_LOG_…`.
#[derive(Clone)]
pub struct LogReport {
    pub raw: sys::lks_log_report,
}

impl LogReport {
    pub fn is_same(&self) -> bool {
        self.raw.outcome == sys::LKS_LOG_SAME
    }
    pub fn line(&self) -> String {
        text_in(&self.raw.line)
    }
}

/// Where two logs differ.
#[derive(Clone)]
pub struct Bisection {
    pub raw: sys::lks_bisect_report,
}

impl Bisection {
    pub fn line(&self) -> String {
        text_in(&self.raw.line)
    }
}

/// A tick of a log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tick {
    pub number: u64,
    /// The players' inputs one after another.
    pub inputs: Vec<u8>,
    /// `sys::LKS_INPUT_…`, one for each slot.
    pub origins: Vec<u32>,
    /// After the tick.
    pub hash: u64,
}

/// A recorded match. Iterating gives its ticks; an iteration that ends early met damage, which
/// `verify` names.
pub struct Log<G: Game> {
    handle: *mut sys::lks_log,
    info: sys::lks_log_info,
    game: PhantomData<G>,
}

impl<G: Game> Drop for Log<G> {
    fn drop(&mut self) {
        unsafe { sys::lks_log_close(self.handle) }
    }
}

impl<G: Game> Log<G> {
    pub fn open(path: &str) -> Result<Self> {
        let path = c_text(path)?;
        let mut handle = ptr::null_mut();
        check(unsafe { sys::lks_log_open(path.as_ptr(), &mut handle) })?;
        Self::adopt(handle)
    }
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let mut handle = ptr::null_mut();
        check(unsafe { sys::lks_log_open_bytes(bytes.as_ptr().cast(), bytes.len(), &mut handle) })?;
        Self::adopt(handle)
    }
    fn adopt(handle: *mut sys::lks_log) -> Result<Self> {
        let mut log = Log { handle, info: sized!(lks_log_info), game: PhantomData };
        check(unsafe { sys::lks_log_get_info(handle, &mut log.info) })?;
        Ok(log)
    }
    pub fn info(&self) -> &sys::lks_log_info {
        &self.info
    }
    /// Computes every tick again and compares the hashes.
    pub fn verify(&mut self, game: &GameLibrary<G>) -> Result<LogReport> {
        let mut raw = sized!(lks_log_report);
        check(unsafe { sys::lks_log_verify(self.handle, game.as_ptr(), &mut raw) })?;
        Ok(LogReport { raw })
    }
    /// The first tick, body and field in which two logs differ.
    pub fn bisect(&mut self, other: &mut Log<G>, game: &GameLibrary<G>) -> Result<Option<Bisection>> {
        let mut raw = sized!(lks_bisect_report);
        check(unsafe { sys::lks_log_bisect(self.handle, other.handle, game.as_ptr(), &mut raw) })?;
        Ok((raw.found == 1).then(|| Bisection { raw }))
    }
    /// The match at a tick; the iteration goes on from there.
    pub fn seek(&mut self, game: &GameLibrary<G>, tick: u64) -> Result<Simulation<G>> {
        let mut simulation = ptr::null_mut();
        check(unsafe { sys::lks_log_seek(self.handle, game.as_ptr(), tick, &mut simulation) })?;
        Ok(Simulation::adopt(simulation))
    }
}

impl<G: Game> Iterator for Log<G> {
    type Item = Tick;

    fn next(&mut self) -> Option<Tick> {
        let simulation = &self.info.simulation;
        let mut tick = Tick {
            number: 0,
            inputs: vec![0; (simulation.player_count * simulation.input_bytes) as usize],
            origins: vec![0; simulation.player_count as usize],
            hash: 0,
        };
        let status = unsafe {
            sys::lks_log_next(
                self.handle,
                &mut tick.number,
                tick.inputs.as_mut_ptr().cast(),
                tick.inputs.len(),
                tick.origins.as_mut_ptr(),
                &mut tick.hash,
            )
        };
        (status == sys::LKS_OK).then_some(tick)
    }
}
