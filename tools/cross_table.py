"""Runs the golden scenes of several builds of the lockstone command and compares their hashes; has each
check the golden vectors of the numerics and verify a recorded match.

usage: cross_table.py [--jobs N] [--junit FILE] TARGET=COMMAND…

COMMAND may begin with an emulator: `s390x=qemu-s390x build/cross/s390x/tools/lockstone`; options behind
` :: ` are added to each run of a scene. The first target lists the scenes, records the match and is the
one that the others are compared with. Exits 1 on a difference.
"""

import argparse
import concurrent.futures
import json
import pathlib
import shlex
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

TIMEOUT_SECONDS = 900
MATCH_TICKS = 300


class Target:
    """A command, and the options that are added when it runs a scene."""

    def __init__(self, text):
        command, _, options = text.partition(" :: ")
        self.command, self.options = shlex.split(command), shlex.split(options)


def ask(command, *arguments):
    """The JSON that the command prints."""
    done = subprocess.run([*command, *arguments, "--json"], capture_output=True, text=True,
                          timeout=TIMEOUT_SECONDS)
    if done.returncode != 0:
        last = (done.stderr.strip() or done.stdout.strip() or "no output").splitlines()[-1]
        raise RuntimeError(f"exit status {done.returncode}: {last}")
    return json.loads(done.stdout)


def run_scene(target, scene):
    """(final hash, chain of hashes), or the reason why there is none."""
    try:
        answer = ask(target.command, "run", "--scene", scene["name"], "--ticks",
                     str(scene["golden_ticks"]), *target.options)
        return answer["final_hash"], answer["chain"]
    except (RuntimeError, OSError, ValueError, KeyError, subprocess.TimeoutExpired) as error:
        return str(error)


def check_numerics(target):
    """(table cell, complaint or None) of the golden vectors."""
    try:
        return f"{ask(target.command, 'numerics', '--check')['vectors']} same", None
    except (RuntimeError, OSError, ValueError, KeyError, subprocess.TimeoutExpired) as error:
        return "differ !", str(error)


def record_match(target, folder):
    """A log of bots in the arena that every build can read."""
    log = pathlib.Path(folder) / "match.lks"
    subprocess.run([*target.command, "record", str(log), "--plain", "--ticks", str(MATCH_TICKS),
                    "--keyframes", "100"], check=True, capture_output=True, timeout=TIMEOUT_SECONDS)
    return str(log)


def verify_match(target, log):
    """(table cell, complaint or None) of the recorded match."""
    try:
        done = subprocess.run([*target.command, "verify", "--strict", "--json", log],
                              capture_output=True, text=True, timeout=TIMEOUT_SECONDS)
        report = json.loads(done.stdout)[0]
        if done.returncode == 0 and report["ticks_verified"] == MATCH_TICKS:
            return report["final_hash"].removeprefix("0x")[:12], None
        return "differs !", report["line"]
    except (OSError, ValueError, KeyError, IndexError, subprocess.TimeoutExpired) as error:
        return "failed", str(error)


def write_junit(path, targets, cases):
    """`cases`: {(target, case): complaint or None}."""
    root = ElementTree.Element("testsuites")
    for target in targets:
        suite = ElementTree.SubElement(root, "testsuite", name=f"cross.{target}")
        for (of, name), complaint in cases.items():
            if of != target:
                continue
            case = ElementTree.SubElement(suite, "testcase", classname=f"cross.{target}", name=name)
            if complaint:
                ElementTree.SubElement(case, "failure", message=complaint)
        suite.set("tests", str(len(suite)))
        suite.set("failures", str(len(suite.findall("./testcase/failure"))))
    ElementTree.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)


def first_difference(chain, reference):
    """Where two chains part, for the message."""
    for position, (here, there) in enumerate(zip(chain, reference)):
        if here != there:
            return f"chain entry {position}: {json.dumps(here)} here, {json.dumps(there)} there"
    if len(chain) != len(reference):
        return f"chain of {len(chain)} entries here, {len(reference)} there"
    return "equal chains, another final hash"


def judge(result, reference):
    """(table cell, complaint or None) of one run."""
    if isinstance(result, str):
        return "failed", result
    final_hash, chain = result
    cell = final_hash.removeprefix("0x")[:12]
    if isinstance(reference, str) or result == reference:
        return cell, None
    return cell + " !", first_difference(chain, reference[1])


def print_table(rows):
    widths = [max(map(len, column)) for column in zip(*rows)]
    for row in rows:
        print("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip())


def report(targets, scenes, results, checks):
    """Prints the table and the complaints; returns {(target, case): complaint or None}."""
    rows = [["scene", "ticks", *targets]]
    cases = {}

    def add_row(name, ticks, judged):
        rows.append([name, str(ticks), *(cell for cell, _ in judged.values())])
        cases.update({(target, name): complaint for target, (_, complaint) in judged.items()})

    for name, judged in checks.items():
        add_row(name, MATCH_TICKS if name == "match" else "", judged)
    for scene in scenes:
        reference = results[next(iter(targets)), scene["name"]]
        add_row(scene["name"], scene["golden_ticks"],
                {target: judge(results[target, scene["name"]], reference) for target in targets})
    print_table(rows)
    for (target, name), complaint in cases.items():
        if complaint:
            print(f"{name} on {target}: {complaint}")
    return cases


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--junit", metavar="FILE")
    parser.add_argument("targets", nargs="+", metavar="TARGET=COMMAND")
    arguments = parser.parse_args()
    targets = {}
    for text in arguments.targets:
        name, _, command = text.partition("=")
        targets[name] = Target(command)

    first = next(iter(targets.values()))
    try:
        scenes = ask(first.command, "scenes")
    except (RuntimeError, OSError, ValueError, subprocess.TimeoutExpired) as error:
        sys.exit(f"cannot list the scenes: {error}")
    if not scenes:
        sys.exit("there is no golden scene")
    with tempfile.TemporaryDirectory() as folder, \
            concurrent.futures.ThreadPoolExecutor(max(1, arguments.jobs)) as pool:
        log = record_match(first, folder)
        # Slow ones first: emulators are named last.
        jobs = {(name, scene["name"]): pool.submit(run_scene, target, scene)
                for name, target in reversed(targets.items()) for scene in scenes}
        numerics = {name: pool.submit(check_numerics, target) for name, target in targets.items()}
        matches = {name: pool.submit(verify_match, target, log) for name, target in targets.items()}
        results = {key: job.result() for key, job in jobs.items()}
        checks = {"numerics": {name: job.result() for name, job in numerics.items()},
                  "match": {name: job.result() for name, job in matches.items()}}

    cases = report(targets, scenes, results, checks)
    if arguments.junit:
        write_junit(arguments.junit, targets, cases)
    complaints = sum(1 for complaint in cases.values() if complaint)
    verdict = f"{complaints} of them differ or failed" if complaints else "all equal"
    print(f"{len(results)} runs of {len(scenes)} scenes on {len(targets)} targets: {verdict}")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
