#!/usr/bin/env python3
"""Writes the declarations of the C interface for Rust, C#, Python and TypeScript, from its headers.

usage: generate.py [--check]

  --check   write nothing; fail where a file is not the generated one
"""

import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
HEADERS = sorted((HERE / "c/lockstone_c").glob("*.h")) + [HERE.parent / "tool/include/lockstone/game_abi.h"]
# The WebAssembly of tools/web has these: no sockets, no servers, no functions of the caller's.
WEB_HEADERS = [HERE / f"c/lockstone_c/{name}.h" for name in
               ("base", "units", "assets", "world", "bodies", "joints", "ragdolls", "vehicles", "terrain", "events",
                "queries", "state", "games", "recorders", "transports", "sessions", "clients")]
WEB_HEADERS += [HERE.parent / f"web/native/{name}.h" for name in ("lockstone_web", "lockstone_web_session")]
WEB_ABSENT = re.compile(r"lks_(enet|network|game_create|issue|now)|_on_(sample|predict)$|lks_recorder_create$")
NOTE = "Written by tools/bindings/generate.py from the C headers, which document each declaration."


class Interface:
    """The declarations of the headers, in their order, without functions whose names `absent` matches."""

    def __init__(self, headers, absent=None):
        self.aliases, self.constants, self.opaque, self.structs, self.functions, self.callbacks = {}, {}, [], {}, {}, {}
        for header in headers:
            self.read(header.read_text(encoding="utf-8"))
        self.functions = {name: kind for name, kind in self.functions.items() if not absent or not absent.search(name)}
        named = set(re.findall(r"struct (lockstone_\w+)", " ".join(f[0] + str(f[1]) for f in self.functions.values())))
        self.opaque = [name for name in self.opaque if name not in self.structs]
        missing = named - set(self.structs)
        if missing:
            sys.exit(f"unknown structures: {missing}")

    def read(self, text):
        text = re.sub(r"/\*.*?\*/|//[^\n]*", " ", text, flags=re.DOTALL)
        for name, value in re.findall(r"^#define (L\w+) (\d+)u? *$", text, re.MULTILINE):
            self.constants[name] = (int(value), "u32")
        text = re.sub(r"^static inline[^{;]*\{.*?^\}", "", text, flags=re.DOTALL | re.MULTILINE)
        text = re.sub(r"^#.*?(?<!\\)$", "", text, flags=re.DOTALL | re.MULTILINE)
        text = re.sub(r"\bLKS_API\b|\bLOCKSTONE_GAME_EXPORT\b|extern \"C\" \{", " ", text)
        for statement in self.statements(text):
            self.declare(statement)

    @staticmethod
    def statements(text):
        depth, begin = 0, 0
        for i, mark in enumerate(text):
            depth += (mark == "{") - (mark == "}")
            if mark == ";" and depth <= 0:
                yield " ".join(text[begin:i].split()).lstrip("} ")
                begin, depth = i + 1, 0

    def declare(self, text):
        if match := re.fullmatch(r"enum(?: \w+)? \{ (.*?),? \}", text):
            entries = [entry.split(" = ") for entry in match[1].split(", ")]
            kind = "i32" if re.match(r"LKS_(OK|POSITION_BITS)|LOCKSTONE_GAME_OK", match[1]) else "u32"
            self.constants.update({name: (int(value), kind) for name, value in entries})
        elif match := re.fullmatch(r"typedef struct (\w+) \{ (.*) \} \w+", text):
            self.structs[match[1]] = [field for part in match[2].split(";") if part.strip()
                                      for field in self.fields(part.strip())]
        elif match := re.fullmatch(r"(?:typedef )?struct (\w+)(?: \w+)?", text):
            if match[1] not in self.opaque:
                self.opaque.append(match[1])
        elif match := re.fullmatch(r"typedef (\w+) (\w+)", text):
            self.aliases[match[2]] = match[1]
        elif match := re.fullmatch(r"typedef ([\w* ]+) \(\*(\w+)\)\((.*)\)", text):
            self.callbacks[match[2]] = (match[1], self.parameters(match[3]))
        elif match := re.fullmatch(r"([\w ]+[\w*] \*?)(\w+)\((.*)\)", text):
            self.functions[match[2]] = (match[1].strip(), self.parameters(match[3]))
        elif text:
            sys.exit(f"not understood: {text}")

    def fields(self, text):
        """(name, type, count or None); a type that begins with ( is a function's."""
        if match := re.fullmatch(r"([\w* ]+?) ?\(\*(\w+)\)\((.*)\)", text):
            return [(match[2], ("callback", match[1], self.parameters(match[3])), None)]
        kind, names = re.fullmatch(r"((?:const )?(?:struct )?\w+\*?) (.*)", text).groups()
        result = []
        for name in names.split(", "):
            array = re.fullmatch(r"(\w+)\[(\w+)\]", name)
            count = None
            if array:
                count = self.constants[array[2]][0] if not array[2].isdigit() else int(array[2])
            result.append((array[1] if array else name, kind, count))
        return result

    @staticmethod
    def parameters(text):
        if text.strip() in ("void", ""):
            return []
        return [re.fullmatch(r"(.*?[ *])(\w+)", part.strip()).groups() for part in text.split(",")]

    def plain(self, kind):
        kind = kind.removeprefix("struct ")
        while kind in self.aliases and kind != "lks_status":
            kind = self.aliases[kind]
        return kind


def pointers(kind):
    """(base, [whether each level from the inside out points to const])."""
    kind = kind.strip()
    levels = kind.count("*")
    base = kind.replace("*", "").strip()
    const = base.startswith("const ")
    return base.removeprefix("const ").removeprefix("struct ").strip(), [const] + [False] * (levels - 1) if levels else []


RUST = {"int32_t": "i32", "uint32_t": "u32", "int64_t": "i64", "uint64_t": "u64", "uint8_t": "u8", "uint16_t": "u16",
        "size_t": "usize", "char": "c_char", "void": "c_void", "int": "i32"}


def rust_type(kind):
    base, levels = pointers(kind)
    text = RUST.get(base, base)
    for const in levels:
        text = ("*const " if const else "*mut ") + text
    return text


def rust_function(result, parameters, named):
    names = ", ".join(f"{name}: {rust_type(kind)}" if named else rust_type(kind)
                      for kind, name in parameters)
    base, levels = pointers(result)
    return f"({names})" + ("" if base == "void" and not levels else f" -> {rust_type(result)}")


def rust_field(field):
    name, kind, count = field
    if isinstance(kind, tuple):
        text = f"Option<unsafe extern \"C\" fn{rust_function(kind[1], kind[2], False)}>"
    else:
        text = rust_type(kind)
    return f"    pub {name}: {f'[{text}; {count}]' if count else text},"


def rust(c):
    lines = ["// " + NOTE, "#![allow(non_camel_case_types)]", "#![allow(clippy::all)]", "#![cfg_attr(rustfmt, rustfmt_skip)]", "",
             "use std::os::raw::{c_char, c_void};", ""]
    lines += [f"pub type {name} = {RUST.get(of, of)};" for name, of in c.aliases.items()] + [""]
    lines += [f"pub const {name}: {kind} = {value};" for name, (value, kind) in c.constants.items()] + [""]
    for name in c.opaque:
        lines += ["#[repr(C)]", f"pub struct {name} {{", "    _private: [u8; 0],", "}"]
    lines.append("")
    for name, (result, parameters) in c.callbacks.items():
        lines.append(f"pub type {name} = Option<unsafe extern \"C\" fn{rust_function(result, parameters, True)}>;")
    lines.append("")
    for name, fields in c.structs.items():
        lines += ["#[repr(C)]", "#[derive(Clone, Copy)]", f"pub struct {name} {{", *map(rust_field, fields), "}"]
    lines += ["", 'extern "C" {']
    lines += [f"    pub fn {name}{rust_function(result, parameters, True)};"
              for name, (result, parameters) in c.functions.items() if name.startswith("lks_")]
    return "\n".join(lines + ["}", ""])


SHARP = {"int32_t": "int", "uint32_t": "uint", "int64_t": "long", "uint64_t": "ulong", "uint8_t": "byte",
         "uint16_t": "ushort", "size_t": "UIntPtr", "char": "byte", "void": "void", "int": "int"}
SHARP_WORDS = {"event", "in", "out", "object", "params", "ref", "base", "lock", "fixed", "is"}


def sharp_type(c, kind, callbacks="IntPtr"):
    base, levels = pointers(kind)
    base = c.plain(base)
    if base in c.callbacks:
        return callbacks
    if base in c.opaque:
        return "IntPtr" + "*" * (len(levels) - 1)
    text = "int" if base == "lks_status" else SHARP.get(base, base)
    return text + "*" * len(levels)


def sharp_fields(c, field):
    name, kind, count = field
    name = "@" + name if name in SHARP_WORDS else name
    if isinstance(kind, tuple):
        return [f"        public IntPtr {name};"]
    text = sharp_type(c, kind)
    if count and text in ("byte", "int", "uint", "long", "ulong"):
        return [f"        public fixed {text} {name}[{count}];"]
    if count:
        return [f"        public {text} {name}_{i};" for i in range(count)]
    return [f"        public {text} {name};"]


def sharp_parameters(c, parameters):
    return ", ".join(f"{sharp_type(c, kind)} {'@' if name in SHARP_WORDS else ''}{name}" for kind, name in parameters)


def sharp_delegates(c):
    """One for each function that a program gives: callbacks, and the members of the game's table."""
    found = dict(c.callbacks)
    for name, kind, _ in c.structs["lockstone_game_table"]:
        if isinstance(kind, tuple):
            found["lockstone_game_" + name + "_function"] = kind[1:]
    for name, (result, parameters) in found.items():
        yield "    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]"
        yield f"    public unsafe delegate {sharp_type(c, result)} {name}({sharp_parameters(c, parameters)});"


def sharp(c):
    lines = ["// " + NOTE, "using System;", "using System.Runtime.InteropServices;", "", "namespace Lockstone.Interop", "{"]
    for name, fields in c.structs.items():
        lines += ["    [StructLayout(LayoutKind.Sequential)]", f"    public unsafe struct {name}", "    {",
                  *[line for field in fields for line in sharp_fields(c, field)], "    }", ""]
    lines += [*sharp_delegates(c), "", "    public static unsafe class Native", "    {",
              '        const string Library = "lockstone_c";', ""]
    kinds = {"i32": "int", "u32": "uint"}
    lines += [f"        public const {kinds[kind]} {name} = {value};" for name, (value, kind) in c.constants.items()]
    for name, (result, parameters) in c.functions.items():
        if not name.startswith("lks_"):
            continue
        lines += ["", "        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]",
                  f"        public static extern {sharp_type(c, result)} {name}({sharp_parameters(c, parameters)});"]
    return "\n".join(lines + ["    }", "}", ""])


CTYPES = {"int32_t": "c_int32", "uint32_t": "c_uint32", "int64_t": "c_int64", "uint64_t": "c_uint64", "uint8_t": "c_uint8",
          "uint16_t": "c_uint16", "size_t": "c_size_t", "char": "c_char", "int": "c_int32"}


def ctypes_type(c, kind):
    base, levels = pointers(kind)
    base = c.plain(base)
    if base in c.callbacks:
        return base
    if not levels:
        return "None" if base == "void" else "c_int32" if base == "lks_status" else CTYPES.get(base, base)
    if base == "char" and levels == [True]:
        return "c_char_p"
    if base in ("void", "uint8_t", "char") or base in c.opaque:
        return "c_void_p" if len(levels) == 1 else "POINTER(c_void_p)"
    return f"POINTER({CTYPES.get(base, base)})"


def ctypes_function(c, result, parameters):
    return ", ".join(ctypes_type(c, kind) for kind in [result] + [kind for kind, _ in parameters])


def ctypes_structure(c, name, fields):
    lines = [f"class {name}(Structure):", "    _fields_ = ["]
    for field, kind, count in fields:
        text = f"CFUNCTYPE({ctypes_function(c, *kind[1:])})" if isinstance(kind, tuple) else ctypes_type(c, kind)
        lines.append(f'        ("{field}", {text}{f" * {count}" if count else ""}),')
    return lines + ["    ]", "", ""]


def in_order_of_use(c):
    """The structures, each after those that it contains or points to."""
    done = []

    def visit(name):
        for _, kind, _ in c.structs[name]:
            texts = [kind] if isinstance(kind, str) else [kind[1], *(text for text, _ in kind[2])]
            for base in (c.plain(pointers(text)[0]) for text in texts):
                if base in c.structs and base not in done:
                    visit(base)
        if name not in done:
            done.append(name)

    for name in c.structs:
        visit(name)
    return done


def python(c):
    lines = ["# " + NOTE, "# flake8: noqa",
             "from ctypes import (CFUNCTYPE, POINTER, Structure, c_char, c_char_p, c_int32, c_int64, c_size_t, c_uint8,",
             "                    c_uint16, c_uint32, c_uint64, c_void_p)", ""]
    lines += [f"{name} = {value}" for name, (value, _) in c.constants.items()] + [""]
    lines += [f"{name} = CFUNCTYPE({ctypes_function(c, *kind)})" for name, kind in c.callbacks.items()] + ["", ""]
    for name in in_order_of_use(c):
        lines += ctypes_structure(c, name, c.structs[name])
    lines += ["# The types of the result and of the arguments.", "FUNCTIONS = {"]
    lines += [f'    "{name}": [{ctypes_function(c, *kind)}],' for name, kind in c.functions.items() if name.startswith("lks_")]
    return "\n".join(lines + ["}", ""])


WEB_SIZES = {"int8_t": 1, "uint8_t": 1, "char": 1, "int16_t": 2, "uint16_t": 2, "int32_t": 4, "uint32_t": 4, "int": 4,
             "float": 4, "size_t": 4, "int64_t": 8, "uint64_t": 8}


class WebLayouts:
    """Places of the fields of structures in WebAssembly's memory, whose pointers have 32 bits."""

    def __init__(self, c):
        self.c, self.found = c, {}

    def measure(self, kind):
        """(bytes, alignment) of a type."""
        base, levels = pointers(kind)
        base = "int32_t" if base == "lks_status" else self.c.plain(base)
        if levels:
            return 4, 4
        if base in self.c.structs:
            fields = self.layout(base)
            return fields["bytes"], fields["alignment"]
        return WEB_SIZES[base], WEB_SIZES[base]

    def layout(self, name):
        if name in self.found:
            return self.found[name]
        places, end, most = {}, 0, 1
        for field, kind, count in self.c.structs[name]:
            size, alignment = self.measure(kind)
            end = (end + alignment - 1) // alignment * alignment
            places[field] = end
            end, most = end + size * (count or 1), max(most, alignment)
        end = (end + most - 1) // most * most
        self.found[name] = {"places": places, "bytes": end, "alignment": most}
        return self.found[name]


def web_type(c, kind):
    base, levels = pointers(kind)
    base = c.plain(base)
    if levels:
        return "number"
    return "void" if base == "void" else "bigint" if base in ("int64_t", "uint64_t") else "number"


def web_function(c, name, result, parameters):
    arguments = ", ".join(f"{parameter}: {web_type(c, kind)}" for kind, parameter in parameters)
    return f"  {name}({arguments}): {web_type(c, result)};"


def typescript(c):
    layouts = WebLayouts(c)
    lines = ["// " + NOTE, "", "// Constants."]
    lines += [f"export const {name} = {value};" for name, (value, _) in c.constants.items()]
    lines += ["", "// Places of the fields of each structure in memory, and its size in bytes as `$bytes`."]
    for name in c.structs:
        layout = layouts.layout(name)
        places = "".join(f", {field}: {place}" for field, place in layout["places"].items())
        lines.append(f"export const {name} = {{ $bytes: {layout['bytes']}{places} }} as const;")
    lines += ["", "/** The functions of the module. Pointers and sizes are numbers, 64-bit integers are bigints. */",
              "export interface Functions {"]
    lines += [web_function(c, name, *kind) for name, kind in c.functions.items()]
    return "\n".join(lines + ["}", ""])


def web_interface(c):
    web = Interface(WEB_HEADERS, WEB_ABSENT)
    web.functions["lks_verify_log_bytes"] = c.functions["lks_verify_log_bytes"]
    web.structs["lks_log_report"] = c.structs["lks_log_report"]
    return web


def main():
    c = Interface(HEADERS)
    files = {HERE / "rust/lockstone-sys/src/lib.rs": rust(c),
             HERE / "csharp/com.lockstone.core/Runtime/Native.cs": sharp(c),
             HERE / "python/lockstone/_declarations.py": python(c),
             HERE.parent / "web/src/declarations.ts": typescript(web_interface(c))}
    stale = [path for path, text in files.items() if not path.exists() or path.read_text(encoding="utf-8") != text]
    if sys.argv[1:] == ["--check"]:
        sys.exit("\n".join(f"{path} is not the generated one: run {__file__}" for path in stale) or 0)
    for path in stale:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(files[path], encoding="utf-8")
    print(f"{len(c.functions)} functions, {len(c.structs)} structures, {len(c.constants)} constants")


main()
