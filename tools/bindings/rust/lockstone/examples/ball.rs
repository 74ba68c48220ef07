use lockstone::units::{length_mm, position_mm, position_to_mm, vec64};
use lockstone::{sys, BodyDef, Result, Shape, World, WorldDef};

fn main() -> Result<()> {
    let mut world_def = WorldDef::default();
    world_def.body_capacity = 64;
    let mut world = World::new(&world_def)?;

    let mut def = BodyDef::default();
    def.motion = sys::LKS_STATIC;
    def.shape = Shape::half_space();
    world.create_body(&def)?;

    let mut def = BodyDef::default();
    def.shape = Shape::sphere(length_mm(250));
    def.position = vec64(0, position_mm(10_000), 0);
    let ball = world.create_body(&def)?;

    for _ in 0..120 {
        world.step()?; // two seconds
    }
    let height = position_to_mm(world.pose(ball)?.position.y);
    println!("y = {height} mm, hash {:016x}", world.hash());
    Ok(())
}
