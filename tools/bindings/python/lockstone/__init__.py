"""Lockstone for Python: a deterministic fixed-point physics core, by ctypes over liblockstone_c.

LOCKSTONE_LIBRARY names the library's file where the system does not find it.
"""

from typing import List

from ._library import LockstoneError, lib
from .games import (ABSENT, CANONICAL, NATIVE, NEUTRAL, RECEIVED, REPEATED, Game, GameLibrary, Info, Input,
                    Simulation)
from .logs import CORRUPT, DIVERGED, INCOMPATIBLE, SAME, Verdict, verify_log
from .recordings import Log, LoggedTick, Recorder
from .sessions import Client, Network, Server, SessionEvent, Transport, now_us, ticks_of
from .shapes import (Assets, box, capsule, cone, cylinder, half_space, rounded_box, sphere,
                     tapered_capsule)
from .units import Raw
from .world import (ALLOW_SLEEP, BALL, BULLET, CONTACT_BEGIN, CONTACT_END, CONTACT_PERSIST, DISTANCE, DYNAMIC,
                    FIXED_ROTATION, GEAR, HINGE, IMPACT, KINEMATIC, MOTOR, PATH, PULLEY, RACK, RATCHET, SIX_AXIS,
                    SLEEP, SLIDER, STATIC, TRIGGER, TRIGGER_ENTER, TRIGGER_EXIT, TRIGGER_STAY, WAKE, WELD, WHEEL, Body,
                    Contact, Impact, Poses, RayHit, World)

__version__ = lib.lks_version().decode()
simulation_abi: int = lib.lks_simulation_abi()
canary_hash: int = lib.lks_canary_hash()


def scene_names() -> List[str]:
    """Of the built-in scenes."""
    return [lib.lks_scene_name(index).decode() for index in range(lib.lks_scene_count())]
