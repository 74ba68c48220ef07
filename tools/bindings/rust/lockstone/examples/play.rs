//! A server and a player of the game over the network:
//!
//!     play serve PLAYERS TICKS LOG   prints "port N", then "tick hash" of each tick
//!     play join PORT [PREDICTION]    the same of a player; PREDICTION ticks of rollback
use lockstone::{
    now_us, sys, Client, ClientDef, ClientState, EnetDef, Event, GameLibrary, Recorder, RecorderDef, Result, Server,
    ServerDef, ServerState, Transport,
};

#[path = "support/pushers.rs"]
mod pushers;
use pushers::Pushers;

fn print_ticks(events: &[Event]) {
    for (tick, hash) in events.iter().filter_map(Event::tick) {
        println!("{tick} {hash:016x}");
    }
}

fn serve(players: u8, ticks: u64, path: &str) -> Result<bool> {
    let simulation = GameLibrary::<Pushers>::new()?.simulation(&[players])?;
    let mut socket = EnetDef::default();
    socket.unlimited = 1; // this match runs as fast as it can
    let transport = Transport::listen(&socket, "127.0.0.1", None)?;
    println!("port {}", transport.port()?);

    let mut log = RecorderDef::default();
    log.replace = 1;
    let mut recorder = Recorder::to_file(&log, &simulation, path)?;
    let mut def = ServerDef::default();
    def.insecure = 1;
    def.pacing = sys::LKS_PACING_FAST;
    def.tick_count = ticks;
    let mut server = Server::new(&def, simulation, transport)?;
    server.record(&recorder)?;
    while server.state() != ServerState::Over {
        print_ticks(server.update(now_us())?);
        server.transport().wait(1000)?;
    }
    recorder.finish("the match is over")?;
    Ok(server.view().finish_reason == sys::LKS_FINISH_COMPLETED)
}

fn join(port: u16, prediction: u32) -> Result<bool> {
    let game = GameLibrary::<Pushers>::new()?;
    let mut def = ClientDef::default();
    def.insecure = 1;
    def.prediction_ticks = prediction;
    def.set_name("Rust");
    let mut client = Client::new(&def, &game, Transport::connect("127.0.0.1", port)?)?;
    client.on_sample(|tick, out| {
        for (i, byte) in out.iter_mut().enumerate() {
            *byte = (tick / 8 * 41 + i as u64 * 89) as u8;
        }
    })?;
    while client.state() < ClientState::Finished {
        print_ticks(client.update(now_us())?);
        client.transport().wait(1000)?;
    }
    if client.state() != ClientState::Finished {
        eprintln!("{}", client.reason());
    }
    Ok(client.state() == ClientState::Finished)
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let number = |text: &str| text.parse::<u64>().expect("a number");
    let done = match words[..] {
        ["serve", players, ticks, log] => serve(number(players) as u8, number(ticks), log),
        ["join", port] => join(number(port) as u16, 0),
        ["join", port, prediction] => join(number(port) as u16, number(prediction) as u32),
        _ => {
            eprintln!("usage: play serve PLAYERS TICKS LOG | join PORT [PREDICTION]");
            std::process::exit(64);
        }
    };
    match done {
        Ok(true) => {}
        Ok(false) => std::process::exit(1),
        Err(error) => {
            eprintln!("{error}");
            std::process::exit(1);
        }
    }
}
