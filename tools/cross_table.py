"""Runs the golden scenes of several builds of the lockstone command and compares their hashes; has each
check the golden vectors of the numerics.

usage: cross_table.py [--jobs N] TARGET=COMMAND…

COMMAND may begin with an emulator: `s390x=qemu-s390x build/cross/s390x/tools/lockstone`. The first
target lists the scenes and is the one that the others are compared with. Exits 1 on a difference.
"""

import argparse
import concurrent.futures
import json
import shlex
import subprocess
import sys

TIMEOUT_SECONDS = 900


def ask(command, *arguments):
    """The JSON that the command prints."""
    done = subprocess.run([*command, *arguments, "--json"], capture_output=True, text=True,
                          timeout=TIMEOUT_SECONDS)
    if done.returncode != 0:
        last = (done.stderr.strip() or done.stdout.strip() or "no output").splitlines()[-1]
        raise RuntimeError(f"exit status {done.returncode}: {last}")
    return json.loads(done.stdout)


def run_scene(command, scene):
    """(final hash, chain of hashes), or the reason why there is none."""
    try:
        answer = ask(command, "run", "--scene", scene["name"], "--ticks", str(scene["golden_ticks"]))
        return answer["final_hash"], answer["chain"]
    except (RuntimeError, OSError, ValueError, KeyError, subprocess.TimeoutExpired) as error:
        return str(error)


def check_numerics(command):
    """(table cell, complaint or None) of the golden vectors."""
    try:
        return f"{ask(command, 'numerics', '--check')['vectors']} same", None
    except (RuntimeError, OSError, ValueError, KeyError, subprocess.TimeoutExpired) as error:
        return "differ !", str(error)


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


def report(targets, scenes, results, numerics):
    """Prints the table and what is wrong; answers the number of complaints."""
    complaints = [f"numerics on {target}: {complaint}"
                  for target, (_, complaint) in numerics.items() if complaint]
    rows = [["scene", "ticks", *targets],
            ["numerics", "", *(numerics[target][0] for target in targets)]]
    for scene in scenes:
        name = scene["name"]
        reference = results[next(iter(targets)), name]
        cells = []
        for target in targets:
            cell, complaint = judge(results[target, name], reference)
            cells.append(cell)
            if complaint:
                complaints.append(f"{name} on {target}: {complaint}")
        rows.append([name, str(scene["golden_ticks"]), *cells])
    print_table(rows)
    for complaint in complaints:
        print(complaint)
    return len(complaints)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("targets", nargs="+", metavar="TARGET=COMMAND")
    arguments = parser.parse_args()
    targets = {}
    for text in arguments.targets:
        name, _, command = text.partition("=")
        targets[name] = shlex.split(command)

    try:
        scenes = ask(next(iter(targets.values())), "scenes")
    except (RuntimeError, OSError, ValueError, subprocess.TimeoutExpired) as error:
        sys.exit(f"cannot list the scenes: {error}")
    if not scenes:
        sys.exit("there is no golden scene")
    with concurrent.futures.ThreadPoolExecutor(max(1, arguments.jobs)) as pool:
        # Slow ones first: emulators are named last.
        jobs = {(name, scene["name"]): pool.submit(run_scene, command, scene)
                for name, command in reversed(targets.items()) for scene in scenes}
        checks = {name: pool.submit(check_numerics, command) for name, command in targets.items()}
        results = {key: job.result() for key, job in jobs.items()}
        numerics = {name: job.result() for name, job in checks.items()}

    complaints = report(targets, scenes, results, numerics)
    verdict = f"{complaints} of them differ or failed" if complaints else "all equal"
    print(f"{len(results)} runs of {len(scenes)} scenes on {len(targets)} targets: {verdict}")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
