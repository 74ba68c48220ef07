"""Includes point one way: base → math → kernels → geometry → collision → dynamics → world within core,
and from floor to floor within each of them and within net and replay; net and replay see core only
through the simulation interface, and never each other; tests and tools are seen by nobody."""

import fnmatch
import pathlib

from cpp_source import Tree, expect_only, includes, run_law

FOLDERS = ["core", "net", "replay"]
# The modules of core, lowest first, and net and replay; of each the floors: folders, lowest first; "" is
# the module's own folder. A floor includes itself and those before it.
FLOORS = {
    "base": [""],
    "math": ["", "wide"],
    "kernels": ["contact", "ball", "box", "points", "rotations", "proximal", ""],
    "geometry": ["numeric", "convex", "distance", "distance/cores", "distance/gjk", "distance/epa",
                 "distance/motion", "contact", "contact/manifold", "contact/feature", "contact/half_space",
                 "contact/round", "contact/box", "contact/polytope", "query", "shapes", "dispatch", "submerged",
                 "mesh_contact", "assets"],
    "collision": ["broad_phase", "narrow_phase", "continuous", "query"],
    "dynamics": ["state", "body", "islands", "contact", "joint", "stack", "problem", "linkage/system",
                 "linkage/rows", "linkage/locks", "linkage/cluster", "linkage", "direct", "impact",
                 "step/input", "step/islands", "step/contacts", "step/limits", "step"],
    "world": ["derived", "debug", "state", "data", "phases", "phases/vehicle", "sleep", "phases/narrow", "phases/motion",
              "commands", "query", "history", ""],
    "net": ["wire", "security", "transport", "transport/udp", "transport/enet",
            "transport/websocket", "routing", "session",
            "session/client", "session/server/data", "session/server/desync", "session/server/leaving",
            "session/server/entry", "session/server/ticks", "session/server/comparison", "session/server"],
    "replay": ["files", "bytes", "codec", "chunks", "reading", "writing", "verifying"],
}
# The modules of core, in their order.
MODULES = [name for name in FLOORS if name not in FOLDERS]
# Its sources define members of one class, which holds every part: only its headers keep to the floors.
HEADERS_ONLY = {"world"}

# The module that each public header of core belongs to: its implementation lives there, and the
# header may include the same modules.
PUBLIC_MODULES = {
    "base": ["assert.h", "bytes.h", "hash.h", "refusal.h", "status.h", "tasks.h",
             "thread_pool.h", "utf8.h"],
    "math": ["decimal.h", "fixed.h", "game_math.h", "literals.h", "quat.h", "random.h", "roots.h", "rotation.h",
             "transform.h", "trigonometry.h", "units.h", "vec3.h", "vector_math.h"],
    "geometry": ["asset.h", "compound.h", "fit.h", "height_field.h", "hull.h", "load_asset.h", "material.h",
                 "mesh.h", "path.h", "scaled_asset.h", "shape.h"],
    "collision": ["collision.h"],
    "dynamics": ["body.h", "fluid.h", "joint.h", "rules.h", "terrain.h", "vehicle.h"],
    "world": ["character.h", "command.h", "contacts.h", "debug_draw.h", "drag.h", "event.h", "predicted_events.h", "profile.h", "query.h", "radial_impulse.h", "ragdoll.h", "rollback_history.h", "shape_pair.h", "simulation.h", "simulation_fields.h", "snapshot.h", "world.h"],
}
# For tools and tests only, so it sees everything and no library may include it.
TESTING = "core/include/lockstone/testing/"
SEAM = {f"core/include/lockstone/{name}.h" for name in ("simulation", "simulation_fields", "bytes", "status", "hash", "assert", "utf8")}

# Libraries of others: who may include them.
THIRD_PARTY = {
    "xxhash.h": "core/base/",
    "enet/*": "net/",
    "libwebsockets.h": "net/transport/websocket/",
    "hwy/*": "core/math/wide/ core/kernels/",
}


def public_module(path):
    name = path.removeprefix("core/include/lockstone/")
    return next((module for module, names in PUBLIC_MODULES.items() if name in names), None)


def module_of(path):
    """(area, module) of a file; the module is None outside core and for a header without an entry."""
    area, _, rest = path.partition("/")
    if area != "core":
        return area, None
    module = public_module(path) if rest.startswith("include/") else rest.partition("/")[0]
    return area, module if module in MODULES else None


def floor_of(path):
    """The floor of a file within its module, or None for a public header or an unknown folder."""
    area, *folders, _ = path.split("/")
    module = area if area != "core" else folders.pop(0) if folders else None
    floor = "/".join(folders)
    return floor if module in FLOORS and floor in FLOORS[module] else None


def resolve(name, quoted, tree):
    """The project's file that an include names, or None when it is not ours."""
    if quoted:
        return name
    if name.startswith("lockstone/"):
        for area in FOLDERS:
            if pathlib.PurePosixPath(f"{area}/include/{name}") in tree.files:
                return f"{area}/include/{name}"
    return None


def floor_refusal(module, floor, other):
    floors = FLOORS[module]
    if floor is not None and other is not None and floors.index(other) > floors.index(floor):
        return f"{module}/{floor} does not see {module}/{other}"
    return None


def refusal(path, target):
    """Why the file may not include the target, or None."""
    area, module = module_of(path)
    other_area, other_module = module_of(target)
    if other_area not in FOLDERS:
        return "a library includes only its own headers, by their path from the root"
    if target.startswith(TESTING):
        return "this header is for tools and tests only"
    if area == "core":
        if other_area != "core":
            return f"core does not know {other_area}"
        if module and other_module and MODULES.index(other_module) > MODULES.index(module):
            return f"{module} does not see {other_module}"
        if module == other_module and not (module in HEADERS_ONLY and path.endswith(".cpp")):
            return floor_refusal(module, floor_of(path), floor_of(target))
    elif other_area == area:
        return floor_refusal(area, floor_of(path), floor_of(target))
    elif other_area == "core" and target not in SEAM:
        return f"{area} sees core only through the simulation interface"
    elif other_area != "core":
        return f"{area} does not see {other_area}"
    return None


def third_party_refusal(path, name):
    for pattern, place in THIRD_PARTY.items():
        if fnmatch.fnmatch(name, pattern) and not path.startswith(tuple(place.split())):
            return f"only {place} uses it"
    return None


def without_place(tree):
    """Files of core that nothing places in a module, and files that nothing places on a floor."""
    for path in map(str, tree.files):
        area = path.partition("/")[0]
        if path.startswith("core/") and not path.startswith(TESTING) and module_of(path)[1] is None:
            yield (f"{path}: has no module: put it into one of {', '.join(MODULES)}; for a public header, "
                   f"by an entry in PUBLIC_MODULES of tests/laws/include_direction.py")
        elif not path.startswith(f"{area}/include/") and floor_of(path) is None:
            yield f"{path}: has no floor: enter its folder in FLOORS of tests/laws/include_direction.py"


def check(tree):
    findings = list(without_place(tree))
    for file, text in tree.items():
        path = file.as_posix()
        if path.startswith(TESTING):
            continue
        for line, name, quoted in includes(text):
            target = resolve(name, quoted, tree)
            why = refusal(path, target) if target else third_party_refusal(path, name)
            if not target and name.startswith("lockstone/"):
                why = "there is no such public header"
            if why:
                findings.append(f"{path}:{line}: includes {name}: {why}")
    return findings


def control():
    headers = {f"core/include/lockstone/{name}": "" for names in PUBLIC_MODULES.values() for name in names}
    headers |= {"net/include/lockstone/session.h": "", "replay/include/lockstone/log.h": "",
                "core/include/lockstone/testing/floating.h": "#include <lockstone/world.h>"}

    def found(path, *names):
        return check(Tree(headers | {path: "".join(f"#include {name}\n" for name in names)}))

    expect_only(found("core/math/a.cpp", "<vector>", '"core/world/world.h"'),
                "core/math/a.cpp:2: includes core/world/world.h: math does not see world")
    expect_only(found("core/geometry/convex/a.cpp", '"core/geometry/distance/gjk/gjk.h"'),
                "geometry/convex does not see geometry/distance")
    expect_only(found("replay/codec/a.cpp", '"replay/chunks/chunk_reader.h"'), "replay/codec does not see replay/chunks")
    expect_only(found("net/attic/a.cpp"), "net/attic/a.cpp: has no floor")
    expect_only(found("core/world/sleep/a.h", '"core/world/world_impl.h"'), "world/sleep does not see world/")
    expect_only(found("core/geometry/hall/a.cpp"), "core/geometry/hall/a.cpp: has no floor")
    expect_only(found("core/base/a.cpp", "<lockstone/fixed.h>"), "base does not see math")
    expect_only(found("core/include/lockstone/vec3.h", "<lockstone/world.h>"), "math does not see world")
    expect_only(found("core/include/lockstone/novel.h"), "novel.h: has no module")
    expect_only(found("core/attic/a.cpp"), "core/attic/a.cpp: has no module")
    expect_only(found("core/world/a.cpp", "<lockstone/session.h>"), "core does not know net")
    expect_only(found("net/wire/a.cpp", "<lockstone/world.h>"), "simulation interface")
    expect_only(found("net/wire/a.cpp", '"core/base/arena.h"'), "simulation interface")
    expect_only(found("net/wire/a.cpp", "<lockstone/log.h>"), "net does not see replay")
    expect_only(found("replay/codec/a.cpp", '"net/wire/wire.h"'), "replay does not see net")
    expect_only(found("replay/codec/a.cpp", '"tests/support/toy.h"'), "only its own headers")
    expect_only(found("core/world/a.cpp", '"tools/scenes/a.h"'), "only its own headers")
    expect_only(found("core/world/a.cpp", '"step.h"'), "by their path from the root")
    expect_only(found("core/world/a.cpp", "<lockstone/testing/floating.h>"), "tools and tests only")
    expect_only(found("core/world/a.cpp", "<lockstone/gone.h>"), "no such public header")
    expect_only(found("core/world/a.cpp", "<enet/enet.h>"), "only net/ uses it")
    # Must pass.
    expect_only(found("core/geometry/distance/a.cpp", '"core/geometry/convex/hull.h"', '"core/geometry/distance/b.h"'))
    expect_only(found("core/world/sleep/a.cpp", '"core/world/world_impl.h"'))
    expect_only(found("core/world/a.cpp", '"core/base/a.h"', "<lockstone/shape.h>", "<xxhash_like.h>"))
    expect_only(found("net/wire/a.cpp", "<lockstone/simulation.h>", '"net/wire/b.h"', "<lockstone/session.h>", "<enet/enet.h>"))
    expect_only(check(Tree(headers | {"core/base/a.cpp": "// #include <lockstone/world.h>\n"})))


if __name__ == "__main__":
    run_law(check, control, FOLDERS)
