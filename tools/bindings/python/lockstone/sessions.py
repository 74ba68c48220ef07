"""Servers and clients of matches, and the transports between them."""

from __future__ import annotations

from ctypes import byref, c_char, c_size_t, c_uint32, c_uint64, c_void_p, memmove
from typing import Any, Callable, List, NamedTuple, Optional, Tuple

from . import _declarations as c
from ._library import lib
from .games import GameLibrary, Simulation, defaults, sized
from .recordings import Recorder


def now_us() -> int:
    """Microseconds of a clock that never runs backwards."""
    return lib.lks_now_us()


class SessionEvent(NamedTuple):
    """Something that happened in the last update; `kind` is one of LKS_SESSION_… of `_declarations`."""

    kind: int
    slot: int
    tick: int
    hash: int
    value: int
    reason: int
    text: str
    data: bytes  # of LKS_SESSION_COMMAND


def _settings(def_: Any, settings: dict) -> Any:
    for name, value in settings.items():
        getattr(def_, name)  # an unknown one is an error
        setattr(def_, name, value.encode() if isinstance(value, str) else int(value))
    return def_


class Transport:
    """Carries the packets of one session."""

    def __init__(self, handle: c_void_p, connection: int = 0) -> None:
        self.handle, self.connection = handle, connection

    def __del__(self) -> None:
        lib.lks_transport_destroy(self.handle)

    @staticmethod
    def listen(address: str = "127.0.0.1", key: Optional[bytes] = None, **settings: int) -> "Transport":
        """A server's UDP socket; settings are the fields of lks_enet_def. With the backend's key it is encrypted."""
        if key is not None and len(key) != 32:
            raise ValueError("a key has 32 bytes")
        made = c_void_p()
        socket = _settings(defaults(c.lks_enet_def, lib.lks_enet_def_init), settings)
        lib.lks_enet_listen(byref(socket), address.encode(), key, byref(made))
        return Transport(made)

    @staticmethod
    def connect(address: str, port: int) -> "Transport":
        made, connection = c_void_p(), c_uint32()
        lib.lks_enet_connect(address.encode(), port, byref(made), byref(connection))
        return Transport(made, connection.value)

    @staticmethod
    def join(token: str) -> "Transport":
        """By the text of a token: encrypted."""
        made, connection = c_void_p(), c_uint32()
        lib.lks_enet_join(token.encode(), byref(made), byref(connection))
        return Transport(made, connection.value)

    @property
    def port(self) -> int:
        port = c_uint32()
        lib.lks_enet_port(self.handle, byref(port))
        return port.value

    def wait(self, limit_us: int) -> None:
        """Sleeps until a datagram has come, at most that long."""
        lib.lks_enet_wait(self.handle, limit_us)


class Network:
    """A network within the process, in the sessions' own time."""

    def __init__(self, seed: int = 1) -> None:
        self.handle = c_void_p()
        lib.lks_network_create(seed, byref(self.handle))

    def __del__(self) -> None:
        lib.lks_network_destroy(self.handle)

    def add(self) -> Transport:
        """The server's end."""
        made = c_void_p()
        lib.lks_network_add(self.handle, byref(made))
        return Transport(made)

    def connect(self, server: Transport, **faults: int) -> Transport:
        """A client's end, which calls the server's; faults are the fields of lks_link_faults."""
        end, connection = self.add(), c_uint32()
        link = _settings(sized(c.lks_link_faults), faults)
        lib.lks_network_connect(self.handle, end.handle, server.handle, byref(link), byref(connection))
        end.connection = connection.value
        return end


def _read_events(prefix: str, handle: c_void_p) -> List[SessionEvent]:
    """Of the last update. The library gives as many as there is room for, and says how many there are."""
    room, count, text = 256, c_size_t(), (c_char * 512)()
    function, text_of = getattr(lib, f"lks_{prefix}_events"), getattr(lib, f"lks_{prefix}_event_text")
    while True:
        raw = (c.lks_session_event * room)()
        try:
            function(handle, raw, room, byref(count))
            break
        except Exception:
            if count.value <= room:
                raise
            room = count.value
    events = []
    for index, event in enumerate(raw[:count.value]):
        text.value, data = b"", b""
        if event.kind == c.LKS_SESSION_COMMAND:
            data = _command(prefix, handle, index, event.value)
        elif event.kind != c.LKS_SESSION_TICK:
            text_of(handle, index, text, len(text))
        events.append(SessionEvent(event.kind, event.slot, event.tick, event.hash, event.value, event.reason,
                                   text.value.decode(errors="replace"), data))
    return events


def _command(prefix: str, handle: c_void_p, index: int, size: int) -> bytes:
    data, count = (c_char * size)(), c_size_t()
    getattr(lib, f"lks_{prefix}_event_bytes")(handle, index, data, size, byref(count))
    return data.raw


def ticks_of(events: List[SessionEvent]) -> List[Tuple[int, int]]:
    """The ticks among the events, with the hashes after them."""
    return [(event.tick, event.hash) for event in events if event.kind == c.LKS_SESSION_TICK]


def _name(prefix: str, handle: c_void_p, slot: int) -> str:
    text = (c_char * 64)()
    getattr(lib, f"lks_{prefix}_player_name")(handle, slot, text, len(text))
    return text.value.decode()


class Server:
    """Seats the players, closes tick after tick, compares states. Settings are the fields of lks_server_def."""

    def __init__(self, simulation: Simulation, transport: Transport, **settings: int) -> None:
        self.simulation, self.transport = simulation, transport
        self.handle = c_void_p()
        def_ = _settings(defaults(c.lks_server_def, lib.lks_server_def_init), settings)
        lib.lks_server_create(byref(def_), simulation.handle, transport.handle, byref(self.handle))

    def __del__(self) -> None:
        lib.lks_server_destroy(self.handle)

    def update(self, now: int) -> List[SessionEvent]:
        """Does all that is due, and returns its events; call it at least once a tick."""
        lib.lks_server_update(self.handle, now)
        return _read_events("server", self.handle)

    def send_command(self, data: bytes) -> None:
        """A command of the server's own."""
        lib.lks_server_send_command(self.handle, data, len(data))

    def record(self, recorder: Recorder) -> None:
        """From here on each tick is written to this log."""
        lib.lks_server_record(self.handle, recorder.handle)

    def stop(self) -> None:
        lib.lks_server_stop(self.handle)

    def player_name(self, slot: int) -> str:
        """The name that a slot's player gave; kept after it left."""
        return _name("server", self.handle, slot)

    @property
    def view(self) -> Any:
        view = sized(c.lks_server_view)
        lib.lks_server_get(self.handle, byref(view))
        return view

    @property
    def over(self) -> bool:
        return self.view.state == c.LKS_SERVER_OVER


class Client:
    """Sends inputs, steps the ticks that the server closed. Settings are the fields of lks_client_def.

    `sample(tick, size)` returns the input of a tick; without it `set_input` holds until the next call."""

    def __init__(self, game: GameLibrary, transport: Transport, sample: Optional[Callable[[int, int], bytes]] = None,
                 **settings: Any) -> None:
        self.game_library, self.transport = game, transport
        self.handle = c_void_p()
        def_ = _settings(defaults(c.lks_client_def, lib.lks_client_def_init), settings)
        lib.lks_client_create(byref(def_), game.handle, transport.handle, transport.connection, byref(self.handle))
        self._sample = c.lks_sample_function()
        if sample is not None:
            def fill(_user: Any, tick: int, out: int, size: int) -> None:
                memmove(out, bytes(sample(tick, size)).ljust(size, b"\0"), size)
            self._sample = c.lks_sample_function(fill)
        lib.lks_client_on_sample(self.handle, self._sample, None)

    def __del__(self) -> None:
        lib.lks_client_destroy(self.handle)

    def update(self, now: int) -> List[SessionEvent]:
        """Does all that is due, and returns its events; call it at least once a tick."""
        lib.lks_client_update(self.handle, now)
        return _read_events("client", self.handle)

    def send_command(self, data: bytes) -> int:
        """Gives a command, 1 … 65536 bytes; it comes back to everybody at a tick. Returns its number."""
        number = c_uint64()
        lib.lks_client_send_command(self.handle, data, len(data), byref(number))
        return number.value

    def set_input(self, data: bytes) -> None:
        lib.lks_client_set_input(self.handle, data, len(data))

    @property
    def view(self) -> Any:
        view = sized(c.lks_client_view)
        lib.lks_client_get(self.handle, byref(view))
        return view

    @property
    def over(self) -> bool:
        """Finished, refused or failed."""
        return self.view.state >= c.LKS_CLIENT_FINISHED

    @property
    def finished(self) -> bool:
        return self.view.state == c.LKS_CLIENT_FINISHED

    @property
    def reason(self) -> str:
        """Why it was refused or failed, for people."""
        text = (c_char * 512)()
        lib.lks_client_reason(self.handle, text, len(text))
        return text.value.decode(errors="replace")

    def player_name(self, slot: int) -> str:
        """The name that a slot's player gave, as the server told it; kept after it left."""
        return _name("client", self.handle, slot)

    @property
    def simulation(self) -> Simulation:
        """The match, for reading; LockstoneError before the server's offer was understood."""
        made = c_void_p()
        lib.lks_client_simulation(self.handle, byref(made))
        return Simulation(self.game_library, made)

    @property
    def stats(self) -> Any:
        stats = sized(c.lks_session_stats)
        lib.lks_client_stats(self.handle, byref(stats))
        return stats

    def leave(self) -> None:
        lib.lks_client_leave(self.handle)
