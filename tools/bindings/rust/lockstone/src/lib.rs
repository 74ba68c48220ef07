//! Deterministic fixed-point lockstep physics for networked games: safe Rust over `liblockstone_c`.
//!
//! Quantities are raw fixed-point integers; [`units`] converts. A world is written by commands
//! alone. A game of your own implements [`Game`]; [`Server`], [`Client`], [`Recorder`] and [`Log`]
//! then play, record and verify its matches. `sys` has the whole C interface.

pub use lockstone_sys as sys;

mod error;
mod game;
mod log;
mod session;
mod transport;
pub mod units;
mod world;

pub use error::{Error, Result};
pub use game::{Game, GameLibrary, GameTable, Info, Input, Origin, Request, Simulation, Snapshot};
pub use log::{Bisection, Log, LogReport, Recorder, RecorderDef, Tick};
pub use session::{now_us, Client, ClientDef, ClientState, Event, Server, ServerDef, ServerState};
pub use transport::{issue_token, EnetDef, LinkFaults, Network, Transport};
pub use world::{Assets, Body, BodyDef, Frame, Hashes, Joint, JointDef, Placed, QueryFilter, Shape, World, WorldDef};

/// The version of the library.
pub fn version() -> &'static str {
    error::text_of(unsafe { sys::lks_version() })
}

/// Changes whenever the same commands may give another state: peers must agree on it.
pub fn simulation_abi() -> u32 {
    unsafe { sys::lks_simulation_abi() }
}

/// This build's hash of a short scene. Peers must agree on it too.
pub fn canary_hash() -> u64 {
    unsafe { sys::lks_canary_hash() }
}
