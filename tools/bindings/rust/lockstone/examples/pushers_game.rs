//! The library of the game, for `lockstone --game libpushers_game.so …`.
#[path = "support/pushers.rs"]
mod pushers;

lockstone::export_game!(pushers::Pushers);
