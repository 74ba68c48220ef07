"""Games of your own, and matches of them."""

from __future__ import annotations

import ctypes
import os
import sys
import traceback
from ctypes import POINTER, byref, c_uint64, c_void_p, cast, memmove, sizeof, string_at
from typing import Any, Callable, Dict, List, NamedTuple, Optional, Sequence, Tuple, Type

from . import _declarations as c
from ._library import LockstoneError, _check, lib

for _name, (_result, *_arguments) in c.FUNCTIONS.items():
    _function = getattr(lib, _name)
    if _function.argtypes is None:
        _function.restype, _function.argtypes = _result, _arguments
        if _result is ctypes.c_int32:
            _function.errcheck = _check

NATIVE, CANONICAL = c.LKS_NATIVE, c.LKS_CANONICAL
RECEIVED, REPEATED, NEUTRAL, ABSENT = range(4)


def sized(kind: Any) -> Any:
    """A structure that begins with its size."""
    return kind(size=sizeof(kind))


def defaults(kind: Any, initialise: Any) -> Any:
    """A structure with the library's defaults."""
    made = kind()
    initialise(byref(made), sizeof(made))
    return made


class Info(NamedTuple):
    """Two peers must agree on all of this before they play."""

    abi: int
    canary: int
    config_hash: int
    scene_hash: int
    players: int
    input_bytes: int
    tick_rate: int = 60


class Input(NamedTuple):
    """Of one player, for one tick. Any bytes are legal: they come from the network."""

    data: bytes
    origin: int


class Game:
    """A deterministic game: only inputs, state and tick decide about a result. An exception out of it ends the
    program. `Game(config)` makes the match at tick 0, or raises ValueError for bytes that it does not know."""

    name = ""
    version = ""

    def __init__(self, config: bytes) -> None:
        raise NotImplementedError

    @property
    def info(self) -> Info:
        raise NotImplementedError

    @property
    def tick(self) -> int:
        raise NotImplementedError

    def step(self, inputs: Sequence[Input]) -> None:
        raise NotImplementedError

    def command(self, slot: int, data: bytes) -> None:
        """A command of the next tick, of a slot or of the server (253): right before step."""

    def snapshot_bytes_max(self, kind: int) -> int:
        raise NotImplementedError

    def save(self, kind: int) -> bytes:
        """The whole state."""
        raise NotImplementedError

    def load(self, kind: int, data: bytes) -> None:
        """Replaces the state, or raises LockstoneError and changes nothing."""
        raise NotImplementedError

    @property
    def hash(self) -> int:
        """Over everything that can change the future."""
        raise NotImplementedError

    def keep_history(self, ticks: int) -> None:
        """From here on remembers the last ticks, as World.keep_history does. A client that predicts asks for it."""

    def forget_history(self) -> None:
        """The next steps simulate in full."""

    def part_hashes(self) -> List[Tuple[str, int]]:
        """Of all parts of the state, at most 8, always the same ones in the same order."""
        return []

    def describe(self, here: bytes, there: bytes) -> Optional[str]:
        """The first difference between two canonical snapshots, for people."""
        return None


def _guarded(function: Callable[..., Any]) -> Callable[..., Any]:
    """ctypes would go on after an exception, with a result that no peer has."""
    def run(*arguments: Any) -> Any:
        try:
            return function(*arguments)
        except BaseException:
            traceback.print_exc()
            sys.stderr.flush()
            os._exit(70)
    return run


class GameLibrary:
    """A game as sessions and logs take it. `kind` derives from Game."""

    def __init__(self, kind: Type[Game]) -> None:
        self.kind = kind
        self._matches: Dict[int, Tuple[Game, Info]] = {}
        self._next = 1
        self._names: Dict[str, ctypes.Array] = {}
        table = c.lockstone_game_table(abi=c.LOCKSTONE_GAME_ABI, bytes=sizeof(c.lockstone_game_table),
                                       name=kind.name.encode(), version=kind.version.encode())
        for name, member in c.lockstone_game_table._fields_:
            function = getattr(self, "_" + name, None)
            if function is not None:
                setattr(table, name, member(_guarded(function)))
        self._table = table  # its functions must outlive the game
        self.handle = c_void_p()
        lib.lks_game_create(byref(table), byref(self.handle))

    def __del__(self) -> None:
        if getattr(self, "handle", None):
            lib.lks_game_destroy(self.handle)

    def simulation(self, config: bytes) -> "Simulation":
        """A match at tick 0."""
        made = c_void_p()
        lib.lks_simulation_create(self.handle, config, len(config), byref(made))
        return Simulation(self, made)

    def game_of(self, match: int) -> Game:
        return self._matches[match][0]

    # The functions of the table.

    def _create(self, config: int, count: int, match: Any) -> int:
        try:
            game = self.kind(string_at(config, count) if count else b"")
        except ValueError:
            return c.LOCKSTONE_GAME_INVALID_ARGUMENT
        self._matches[self._next] = (game, game.info)
        match[0] = self._next
        self._next += 1
        return c.LOCKSTONE_GAME_OK

    def _destroy(self, match: int) -> None:
        del self._matches[match]

    def _info(self, match: int, out: Any) -> None:
        info = self._matches[match][1]
        out[0] = c.lockstone_game_info(info.config_hash, info.scene_hash, info.canary, info.abi, info.tick_rate,
                                       info.players, info.input_bytes)

    def _tick(self, match: int) -> int:
        return self.game_of(match).tick

    def _step(self, match: int, inputs: Any, count: int) -> None:
        game, info = self._matches[match]
        game.step([Input(string_at(inputs[slot].bytes, info.input_bytes), inputs[slot].origin) for slot in range(count)])

    def _command(self, match: int, slot: int, data: int, size: int) -> None:
        self.game_of(match).command(slot, string_at(data, size))

    def _snapshot_bytes_max(self, match: int, kind: int) -> int:
        return self.game_of(match).snapshot_bytes_max(kind)

    def _save(self, match: int, kind: int, out: int, capacity: int) -> int:
        state = self.game_of(match).save(kind)
        if len(state) > capacity:
            return 0
        memmove(out, state, len(state))
        return len(state)

    def _load(self, match: int, kind: int, data: int, count: int) -> int:
        try:
            self.game_of(match).load(kind, string_at(data, count))
        except LockstoneError as error:
            return error.status
        return c.LOCKSTONE_GAME_OK

    def _hash(self, match: int) -> int:
        return self.game_of(match).hash

    def _keep_history(self, match: int, ticks: int) -> None:
        self.game_of(match).keep_history(ticks)

    def _forget_history(self, match: int) -> None:
        self.game_of(match).forget_history()

    def _part_hashes(self, match: int, out: Any) -> int:
        parts = self.game_of(match).part_hashes()
        for index, (name, value) in enumerate(parts):
            kept = self._names.setdefault(name, ctypes.create_string_buffer(name.encode()))
            out[index] = c.lockstone_game_hash(cast(kept, ctypes.c_char_p), value, 0)
        return len(parts)

    def _describe(self, match: int, here: int, here_count: int, there: int, there_count: int, out: Any) -> int:
        text = self.game_of(match).describe(string_at(here, here_count), string_at(there, there_count))
        room = c.LOCKSTONE_GAME_TEXT_BYTES - 1
        out[0] = c.lockstone_game_difference()
        if text is None:
            return 0
        out[0].store, out[0].field = b"state", text.encode()[:room].decode(errors="ignore").encode()
        return 1


class Simulation:
    """A match of a game. That of a session is for reading."""

    def __init__(self, library: GameLibrary, handle: c_void_p) -> None:
        self.library, self.handle = library, handle

    def __del__(self) -> None:
        lib.lks_simulation_destroy(self.handle)

    @property
    def game(self) -> Game:
        match = c_void_p()
        lib.lks_simulation_match(self.handle, cast(byref(match), POINTER(c_void_p)))
        return self.library.game_of(match.value or 0)

    def step(self, inputs: bytes) -> None:
        """`inputs`: the players' inputs one after another, all received."""
        lib.lks_simulation_step(self.handle, inputs, len(inputs), None)

    @property
    def tick(self) -> int:
        tick = c_uint64()
        lib.lks_simulation_tick(self.handle, byref(tick))
        return tick.value

    @property
    def hash(self) -> int:
        value = c_uint64()
        lib.lks_simulation_hash(self.handle, byref(value))
        return value.value
