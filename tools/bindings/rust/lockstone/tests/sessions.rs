//! A match in one process, over a network with losses; its log.
use lockstone::{
    sys, Client, ClientDef, ClientState, Error, Event, Game, GameLibrary, LinkFaults, Log, Network, Recorder,
    RecorderDef, Result, Server, ServerDef, ServerState, Simulation, World, WorldDef,
};

#[path = "../examples/support/pushers.rs"]
mod pushers;
use pushers::Pushers;

const TICKS: u64 = 150;

fn client(
    game: &GameLibrary<Pushers>,
    network: &Network,
    server: &lockstone::Transport,
    prediction: u32,
) -> Result<Client<Pushers>> {
    let faults = LinkFaults { loss_ppm: 50_000, delay_us: 30_000, ..LinkFaults::default() };
    let mut def = ClientDef::default();
    def.insecure = 1;
    def.prediction_ticks = prediction;
    let mut client = Client::new(&def, game, network.connect(server, &faults)?)?;
    client.on_sample(move |tick, out| out.fill((tick / 4 * u64::from(31 + prediction)) as u8))?;
    Ok(client)
}

fn hashes(events: &[Event], into: &mut Vec<u64>) {
    into.extend(events.iter().filter_map(Event::tick).map(|(_, hash)| hash));
}

#[test]
fn a_match_has_equal_hashes_and_a_log_that_verifies() -> Result<()> {
    let game = GameLibrary::<Pushers>::new()?;
    let network = Network::new(3)?;
    let end = network.add()?;
    let mut clients = [client(&game, &network, &end, 0)?, client(&game, &network, &end, 6)?];
    let simulation = game.simulation(&[2])?;
    let mut recorder = Recorder::in_memory(&RecorderDef::default(), &simulation)?;
    let mut def = ServerDef::default();
    def.insecure = 1;
    def.tick_count = TICKS;
    let mut server = Server::new(&def, simulation, end)?;
    server.record(&recorder)?;

    let mut seen = [Vec::new(), Vec::new(), Vec::new()];
    let mut now = 0;
    while server.state() != ServerState::Over && now < 60_000_000 {
        now += 4000;
        hashes(server.update(now)?, &mut seen[0]);
        for (client, seen) in clients.iter_mut().zip(&mut seen[1..]) {
            hashes(client.update(now)?, seen);
        }
    }
    assert_eq!(seen[0].len() as u64, TICKS);
    assert_eq!(seen[0], seen[1]);
    assert_eq!(seen[0], seen[2]);
    assert!(clients.iter().all(|client| client.state() == ClientState::Finished));
    assert!(clients[1].stats().rollbacks > 0);
    assert_eq!(clients[1].simulation().unwrap().hash(), seen[0][TICKS as usize - 1]);

    recorder.finish("over")?;
    let bytes = recorder.bytes()?;
    let mut log = Log::<Pushers>::from_bytes(&bytes)?;
    let report = log.verify(&game)?;
    assert!(report.is_same(), "{}", report.line());
    assert_eq!(report.raw.ticks_verified, TICKS);
    assert_eq!(log.seek(&game, 100)?.hash(), seen[0][99]);
    assert_eq!(log.next().unwrap().hash, seen[0][100]);
    assert!(log.bisect(&mut Log::from_bytes(&bytes)?, &game)?.is_none());
    assert_eq!(Log::<Pushers>::from_bytes(&bytes)?.map(|tick| tick.hash).collect::<Vec<_>>(), seen[0]);
    Ok(())
}

fn played(game: &GameLibrary<Pushers>, push: u8) -> Result<Log<Pushers>> {
    let mut simulation: Simulation<Pushers> = game.simulation(&[1])?;
    let mut recorder = Recorder::in_memory(&RecorderDef::default(), &simulation)?;
    for tick in 0..60 {
        let inputs = [if tick == 40 { push } else { 1 }, 0];
        simulation.step(&inputs)?;
        recorder.step(&inputs)?;
    }
    recorder.finish("over")?;
    Log::from_bytes(&recorder.bytes()?)
}

#[test]
fn logs_that_differ_are_bisected() -> Result<()> {
    let game = GameLibrary::<Pushers>::new()?;
    let found = played(&game, 1)?.bisect(&mut played(&game, 99)?, &game)?.expect("a difference");
    assert_eq!(found.raw.tick, 40);
    assert!(found.line().contains("inputs of player 0"), "{}", found.line());
    Ok(())
}

#[test]
fn refusals_say_why() {
    let game = GameLibrary::<Pushers>::new().unwrap();
    let error = game.simulation(&[0]).err().unwrap();
    assert_eq!(error.status, sys::LKS_INVALID_ARGUMENT);
    assert!(error.to_string().contains("refuses the configuration"), "{error}");
    let mut def = WorldDef::default();
    def.tick_rate = 9;
    let error: Error = World::new(&def).err().unwrap();
    assert!(error.message.contains("tick_rate"), "{error}");
    assert!(Pushers::create(&[1, 2]).is_err());
}
