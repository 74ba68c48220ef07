using System;
using System.Collections.Generic;
using Lockstone.Interop;
using UnityEngine;

namespace Lockstone.Unity
{
    /// <summary>Drives a client once a frame, and moves transforms between the last two ticks: frames do not coincide
    /// with ticks. Nothing that it computes flows back into the match.</summary>
    public abstract class MatchBehaviour : MonoBehaviour
    {
        readonly Dictionary<ulong, Transform> shown = new Dictionary<ulong, Transform>();
        ulong[] names = new ulong[0];
        lks_pose[] poses = new lks_pose[0];
        readonly Dictionary<ulong, lks_pose> before = new Dictionary<ulong, lks_pose>();
        int count;
        ulong tick;
        long tickUs;

        /// <summary>The client that is driven; null: nothing happens.</summary>
        protected abstract Client Client { get; }

        /// <summary>The world of a match of your game.</summary>
        protected abstract World WorldOf(Game game);

        /// <summary>The length of a tick.</summary>
        protected virtual long TickUs => 1000000 / 60;

        /// <summary>Called for each event of the client.</summary>
        protected virtual void OnSessionEvent(lks_session_event happened)
        {
        }

        /// <summary>Place of the scene's origin in the world: put it near the camera, and a picture is as steady a
        /// million metres out as at the world's origin.</summary>
        public lks_i64x3 Origin { get; set; }

        /// <summary>From here on the transform follows the body.</summary>
        public void Show(ulong body, Transform transform)
        {
            shown[body] = transform;
        }

        public void Hide(ulong body)
        {
            shown.Remove(body);
        }

        protected virtual void Update()
        {
            if (Client == null) return;
            long now = Library.NowUs;
            ReadOnlySpan<lks_session_event> events = Client.Update(now);
            for (int i = 0; i < events.Length; ++i) OnSessionEvent(events[i]);
            using (Simulation simulation = Client.Simulation)
            {
                if (simulation == null) return;
                Game game = simulation.Game;
                if (count == 0 || game.Tick != tick) TakePoses(WorldOf(game), game.Tick, now);
            }
            float passed = Mathf.Clamp01((now - tickUs) / (float)TickUs);
            for (int i = 0; i < count; ++i) Place(i, passed);
        }

        void TakePoses(World world, ulong newTick, long now)
        {
            before.Clear();
            for (int i = 0; i < count; ++i) before[names[i]] = poses[i];
            count = world.Bodies(names, poses);
            if (count > names.Length)
            {
                names = new ulong[count * 2];
                poses = new lks_pose[count * 2];
                count = world.Bodies(names, poses);
            }
            tick = newTick;
            tickUs = now;
        }

        void Place(int index, float passed)
        {
            Transform transform;
            if (!shown.TryGetValue(names[index], out transform)) return;
            lks_pose from, to = poses[index];
            if (!before.TryGetValue(names[index], out from)) from = to;
            transform.localPosition = Vector3.Lerp(Position(from.position), Position(to.position), passed);
            transform.localRotation = Quaternion.Slerp(Rotation(from.orientation), Rotation(to.orientation), passed);
        }

        /// <summary>The difference is taken in integers. Unity's z axis points the other way.</summary>
        Vector3 Position(lks_i64x3 place)
        {
            const float Metre = 1.0f / (1L << Native.LKS_POSITION_BITS);
            return new Vector3((place.x - Origin.x) * Metre, (place.y - Origin.y) * Metre, (Origin.z - place.z) * Metre);
        }

        static Quaternion Rotation(lks_quat q)
        {
            const float One = 1.0f / (1 << Native.LKS_UNIT_BITS);
            return new Quaternion(-q.x * One, -q.y * One, q.z * One, q.w * One);
        }
    }
}
