using System;
using Lockstone;
using Lockstone.Interop;

static class Ball
{
    static void Main()
    {
        lks_world_def worldDef = Defaults.World();
        worldDef.body_capacity = 64;
        using (var world = new World(worldDef))
        {
            lks_body_def ground = Defaults.Body();
            ground.motion = Native.LKS_STATIC;
            ground.shape = Shape.HalfSpace();
            world.CreateBody(ground);

            lks_body_def ball = Defaults.Body();
            ball.shape = Shape.Sphere(Units.LengthMm(250));
            ball.position = Units.Vec64(0, Units.PositionMm(10000), 0);
            ulong name = world.CreateBody(ball);

            for (int tick = 0; tick < 120; ++tick) world.Step(); // two seconds
            Console.WriteLine("y = {0} mm, hash {1:x16}", Units.PositionToMm(world.Pose(name).position.y), world.Hash);
        }
    }
}
