//! The game of tools/examples/pushers in Rust: every player pushes a ball over a plane.

use std::ffi::CStr;

use lockstone::units::{length_mm, position_mm, vec64};
use lockstone::{canary_hash, simulation_abi, sys};
use lockstone::{Body, BodyDef, Error, Frame, Game, Info, Input, Request, Result, Shape, Snapshot, World, WorldDef};

const MAX_PLAYERS: u8 = 16;

pub struct Pushers {
    world: World,
    balls: Vec<Body>, // follow from the construction: not state
    config_hash: u64,
    scene_hash: u64,
}

fn refuse(status: i32) -> Error {
    Error { status, message: String::new() }
}

impl Game for Pushers {
    const NAME: &'static str = "pushers";
    const VERSION: &'static str = "0.1";

    /// The configuration is one byte: the number of players.
    fn create(config: &[u8]) -> Result<Self> {
        let players = match *config {
            [players] => players,
            _ => return Err(refuse(sys::LKS_MALFORMED)),
        };
        if !(1..=MAX_PLAYERS).contains(&players) {
            return Err(refuse(sys::LKS_INVALID_ARGUMENT));
        }
        let mut def = WorldDef::default();
        def.body_capacity = u32::from(MAX_PLAYERS) + 1;
        let mut world = World::new(&def)?;
        let mut ground = BodyDef::default();
        ground.motion = sys::LKS_STATIC;
        ground.shape = Shape::half_space();
        world.create_body(&ground)?;
        let mut balls = Vec::new();
        for slot in 0..players {
            let mut ball = BodyDef::default();
            ball.shape = Shape::sphere(length_mm(500));
            ball.position = vec64(position_mm(1500 * i64::from(slot)), position_mm(500), 0);
            balls.push(world.create_body(&ball)?);
        }
        let scene_hash = world.hash();
        let config_hash = World::config_hash(&def)?.wrapping_add(u64::from(players));
        Ok(Pushers { world, balls, config_hash, scene_hash })
    }

    fn info(&self) -> Info {
        Info {
            abi: simulation_abi(),
            canary: canary_hash(),
            config_hash: self.config_hash,
            scene_hash: self.scene_hash,
            tick_rate: 60,
            players: self.balls.len() as u8,
            input_bytes: 2,
        }
    }

    fn tick(&self) -> u64 {
        self.world.tick()
    }

    /// Two signed numbers: a push along x and one along z, in N·s times 8.
    fn step(&mut self, inputs: &[Input<'_>]) {
        for (input, &ball) in inputs.iter().zip(&self.balls) {
            let push = |i: usize| i64::from(input.bytes[i] as i8) << (sys::LKS_IMPULSE_BITS - 3);
            let _ = self.world.apply_impulse(ball, vec64(push(0), 0, push(1)), Frame::World);
        }
        let _ = self.world.step();
    }

    fn snapshot_bytes_max(&self, kind: Snapshot) -> usize {
        self.world.snapshot_bytes_max(kind)
    }
    fn save(&self, kind: Snapshot, out: &mut [u8]) -> usize {
        self.world.save(kind, out).unwrap_or(0)
    }
    fn load(&mut self, kind: Snapshot, bytes: &[u8]) -> Result<()> {
        unsafe { self.world.load(kind, bytes) }
    }
    fn keep_history(&mut self, ticks: u32) {
        let _ = self.world.keep_history(ticks);
    }
    fn forget_history(&mut self) {
        let _ = self.world.forget_history();
    }
    fn hash(&self) -> u64 {
        self.world.hash()
    }
    fn part_hashes(&self) -> Vec<(&'static CStr, u64)> {
        let name = |bytes| CStr::from_bytes_with_nul(bytes).unwrap();
        let parts = self.world.part_hashes();
        vec![(name(b"bodies\0"), parts.bodies), (name(b"contacts\0"), parts.contacts)]
    }
    fn describe(&self, here: &[u8], there: &[u8]) -> Option<String> {
        self.world.describe_difference(here, there).ok()?
    }
    fn configure(request: &Request<'_>) -> Result<Vec<u8>> {
        match request.players {
            0 => Ok(vec![2]),
            players if players <= u32::from(MAX_PLAYERS) => Ok(vec![players as u8]),
            _ => Err(refuse(sys::LKS_INVALID_ARGUMENT)),
        }
    }
}
