// GoldenScenes.exe (SCENE TICKS)… prints, for each, its name and the hashes of every tenth tick and of the last.
using System;
using System.Text;
using Lockstone;

static class GoldenScenes
{
    static void Main(string[] words)
    {
        for (int i = 0; i + 1 < words.Length; i += 2)
        {
            ulong ticks = ulong.Parse(words[i + 1]);
            var line = new StringBuilder(words[i]);
            using (var world = new World(words[i], 1))
            {
                for (ulong tick = 1; tick <= ticks; ++tick)
                {
                    world.Step();
                    if (tick % 10 == 0 || tick == ticks) line.AppendFormat(" {0:x16}", world.Hash);
                }
            }
            Console.WriteLine(line);
        }
    }
}
