"""Follows docs/tutorial/first-game.md: writes its files, builds them against an installed Lockstone, runs
the programs, and compares their output with that on the page. Numbers and hashes may differ.

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
PICTURES = ["start.svg", "hit.svg", "end.svg", "match.svg"]
PORT = 47000 + os.getpid() % 1000


def masked(text):
    """Text without numbers and hashes: a newer solver may give others."""
    return re.sub(r"\b[0-9a-f]{16}\b|\d+(?:\.\d+)?", "#", text)


def same_lines(here, there):
    """Whether both texts have the same kinds of lines: how many times the ball hits is no promise."""
    return set(masked(here).splitlines()) == set(masked(there).splitlines())


def run(*words, cwd):
    command = [str(word) for word in words]
    done = subprocess.run(command, cwd=cwd, capture_output=True, text=True, timeout=600, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}: exit code {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done.stdout


def play(folder):
    """A match of three processes: the lines of both players and of the host."""
    def start(*words):
        return subprocess.Popen([folder / "build/play", *words], cwd=folder, stdin=subprocess.PIPE,
                                stdout=subprocess.PIPE, text=True)

    host = start("host", str(PORT))
    time.sleep(0.5)
    players = [start("join", "127.0.0.1", str(PORT)) for _ in range(2)]
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
    hashes = {line.split()[-1] for line in lines}
    if len(hashes) != 1:
        sys.exit(f"play: different hashes: {lines}")
    return "\n".join([lines[0], *sorted(lines[1:])]) + "\n"


def main():
    parser = argparse.ArgumentParser()
    for name in ("page", "prefix", "scratch"):
        parser.add_argument(f"--{name}", required=True, type=pathlib.Path)
    parser.add_argument("--compiler", required=True)
    parser.add_argument("--update", action="store_true")
    arguments = parser.parse_args()

    page = arguments.page.read_text(encoding="utf-8")
    folder = arguments.scratch
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for name, text in FILE.findall(page):
        (folder / name).write_text(text, encoding="utf-8")
    run("cmake", "-S", ".", "-B", "build", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={arguments.prefix}",
        f"-DCMAKE_CXX_COMPILER={arguments.compiler}", "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror", cwd=folder)
    run("cmake", "--build", "build", cwd=folder)
    outputs = [run(folder / "build/knockdown", cwd=folder), run(folder / "build/record", cwd=folder), play(folder)]

    if arguments.update:
        replacements = iter(outputs)
        text = OUTPUT.sub(lambda _: f"```text\n{next(replacements)}```", page)
        arguments.page.write_text(text, encoding="utf-8")
        for picture in PICTURES:
            shutil.copy(folder / picture, arguments.page.parent / picture)
        return None
    expected = OUTPUT.findall(page)
    for here, there in zip(expected, outputs, strict=True):
        if not same_lines(here, there):
            sys.exit(f"the page says\n{here}\nthe programs print\n{there}")
    missing = [picture for picture in PICTURES if not (folder / picture).exists()]
    print(f"{len(FILE.findall(page))} files, {len(outputs)} outputs; pictures missing: {missing}")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
