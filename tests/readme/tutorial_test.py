"""Follows docs/tutorial/first-game.md: writes its files, builds them against an installed Lockstone, runs
the programs, and compares their output with that on the page, hashes included. Of the match that is played live,
and of the mistake of step 6, numbers and hashes may differ.

usage: tutorial_test.py --page PAGE --prefix INSTALLED --scratch FOLDER --compiler CXX [--update]

  --update   write the output and the pictures of this build into the page and its folder
"""

import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

FILE = re.compile(r"^\*\*`([\w.]+)`\*\*\n\n```\w+\n(.*?)^```$", re.DOTALL | re.MULTILINE)
OUTPUT = re.compile(r"^```text\n(.*?)^```$", re.DOTALL | re.MULTILINE)
EXACT_OUTPUTS = 2  # the first ones: of programs without a player
PICTURES = ["start.svg", "hit.svg", "end.svg", "match.svg"]
PORT = 47000 + os.getpid() % 1000


def masked(text):
    """Text without numbers and hashes: they depend on the moment of a throw."""
    return re.sub(r"\b[0-9a-f]{16}\b|\d+(?:\.\d+)?", "#", text)


def run(*words, cwd, code=0):
    command = [str(word) for word in words]
    done = subprocess.run(command, cwd=cwd, capture_output=True, text=True, timeout=600, check=False)
    if done.returncode != code:
        sys.exit(f"{' '.join(command)}: exit code {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done.stdout


def build(folder, arguments):
    run("cmake", "-S", ".", "-B", "build", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={arguments.prefix}",
        f"-DCMAKE_CXX_COMPILER={arguments.compiler}", "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror", cwd=folder)
    run("cmake", "--build", "build", cwd=folder)


def start(folder, *words):
    return subprocess.Popen([folder / "build/play", *words], cwd=folder, stdin=subprocess.PIPE,
                            stdout=subprocess.PIPE, text=True)


def play(folder):
    """A match of three processes: the lines of both players and of the host."""
    host = start(folder, "host", str(PORT))
    time.sleep(0.5)
    players = [start(folder, "join", "127.0.0.1", str(PORT)) for _ in range(2)]
    for throw in ("12 3", "11 5", "12 4"):
        time.sleep(2.5)
        for player in players:
            player.stdin.write(throw + "\n")
            player.stdin.flush()
    lines = []
    for process in [host, *players]:
        lines.append(process.communicate(timeout=60)[0].strip())
        if process.returncode != 0:
            sys.exit(f"play: exit code {process.returncode}: {lines[-1]}")
    hashes = {re.search(r"\b[0-9a-f]{16}\b", line)[0] for line in lines}
    if len(hashes) != 1:
        sys.exit(f"play: different hashes: {lines}")
    return "\n".join([lines[0], *sorted(lines[1:])]) + "\n"


def edit(path, old, new):
    text = path.read_text(encoding="utf-8")
    if text.count(old) != 1:
        sys.exit(f"{path.name}: {text.count(old)} times, not once: {old}")
    path.write_text(text.replace(old, new), encoding="utf-8")


def make_the_mistake(folder, files, arguments):
    """Step 6: a rule that `load` forgets. The line of `record`, and that of a client that tests itself."""
    folder.mkdir()
    for name, text in files:
        (folder / name).write_text(text, encoding="utf-8")
    edit(folder / "game.h", "    if (status == Status::ok) players_ = players;  // everything, or nothing\n", "")
    edit(folder / "play.cpp", "  net::ClientConfig config;\n",
         "  net::ClientConfig config;\n  config.prediction_ticks = 4;\n  config.sync_test = true;\n")
    build(folder, arguments)
    diverged = run(folder / "build/record", cwd=folder, code=1).splitlines()[-1] + "\n"
    host = start(folder, "host", str(PORT + 1))
    time.sleep(0.5)
    players = [start(folder, "join", "127.0.0.1", str(PORT + 1)) for _ in range(2)]
    time.sleep(2)
    players[0].stdin.write("12 3\n")
    players[0].stdin.flush()
    said = players[0].communicate(timeout=60)[0]
    for process in [host, players[1]]:
        process.kill()
        process.communicate()
    return [diverged, said]


def main():
    parser = argparse.ArgumentParser()
    for name in ("page", "prefix", "scratch"):
        parser.add_argument(f"--{name}", required=True, type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("--compiler", required=True)
    parser.add_argument("--update", action="store_true")
    arguments = parser.parse_args()

    page = arguments.page.read_text(encoding="utf-8")
    folder = arguments.scratch
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for name, text in FILE.findall(page):
        (folder / name).write_text(text, encoding="utf-8")
    build(folder, arguments)
    outputs = [run(folder / "build/knockdown", cwd=folder), run(folder / "build/record", cwd=folder), play(folder),
               *make_the_mistake(folder / "mistake", FILE.findall(page), arguments)]

    if arguments.update:
        replacements = iter(outputs)
        text = OUTPUT.sub(lambda _: f"```text\n{next(replacements)}```", page)
        arguments.page.write_text(text, encoding="utf-8")
        for picture in PICTURES:
            shutil.copy(folder / picture, arguments.page.parent / picture)
        return None
    expected = OUTPUT.findall(page)
    for number, (here, there) in enumerate(zip(expected, outputs, strict=True)):
        same = here == there if number < EXACT_OUTPUTS else masked(here) == masked(there)
        if not same:
            sys.exit(f"the page says\n{here}\nthe programs print\n{there}\nsee --update")
    missing = [picture for picture in PICTURES if not (folder / picture).exists()]
    print(f"{len(FILE.findall(page))} files, {len(outputs)} outputs; pictures missing: {missing}")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
