//! golden_scenes (SCENE TICKS)… prints, for each, its name and the hashes of every tenth tick and of the last.
use lockstone::{Result, World};

fn play(name: &str, ticks: u64) -> Result<()> {
    let mut world = World::scene(name, 1)?;
    print!("{name}");
    for tick in 1..=ticks {
        world.step()?;
        if tick % 10 == 0 || tick == ticks {
            print!(" {:016x}", world.hash());
        }
    }
    println!();
    Ok(())
}

fn main() -> Result<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    for pair in words.chunks_exact(2) {
        play(&pair[0], pair[1].parse().expect("a number"))?;
    }
    Ok(())
}
