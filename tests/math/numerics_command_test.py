"""lockstone numerics: this build writes the same vectors, and each kind of damage is found; and
the errors that lockstone bench numerics measures are within the bounds.

usage: numerics_command_test.py LOCKSTONE FILE
"""

import json
import pathlib
import subprocess
import sys
import tempfile


def run(*arguments):
    return subprocess.run([COMMAND, "numerics", *arguments], capture_output=True, text=True, check=False)


def expect(condition, what):
    if not condition:
        sys.exit(f"failed: {what}")


def report_of(path, exit_code):
    result = run("--check", str(path), "--json")
    expect(result.returncode == exit_code, f"exit {result.returncode} of {path.name}")
    return json.loads(result.stdout)


def main(folder):
    written = folder / "written.txt"
    expect(run("--write", str(written)).returncode == 0, "--write")
    expect(written.read_bytes() == VECTORS.read_bytes(), "--write gives the golden file")
    expect(report_of(written, 0)["different"] == 0, "equal")

    lines = VECTORS.read_text(encoding="utf-8").splitlines()
    at = next(i for i, line in enumerate(lines) if line.startswith("tan "))
    damaged = folder / "damaged.txt"
    for change, kind in ((lambda s: s + "1", "different"), (lambda s: "tang" + s[3:], "malformed"),
                         (lambda s: s.replace("tan ", "tan 99999999999 "), "malformed"),
                         (lambda s: s[:6], "malformed")):
        damaged.write_text("\n".join([*lines[:at], change(lines[at]), *lines[at + 1:]]) + "\n",
                           encoding="utf-8")
        report = report_of(damaged, 1)
        expect(report[kind] == 1 and report["first_difference"]["line"] == at + 1, f"{kind}: {report}")
    damaged.write_text("", encoding="utf-8")
    report_of(damaged, 1)
    expect(run("--check", str(folder / "none.txt")).returncode == 2, "a file that is not there")

    bench = subprocess.run([COMMAND, "bench", "numerics", "--json", "--repeats", "1"],
                           capture_output=True, text=True, check=True)
    for row in json.loads(bench.stdout)["functions"]:
        errors = {name: value["max_error"] for name, value in row.items() if isinstance(value, dict)}
        ulp = 2.0 ** -int(row["format"].rpartition("Q")[2])
        expect(errors["lockstone"] <= 0.8 * ulp, f"{row['function']}: {errors} in {ulp}")
        expect(errors["lockstone"] < errors["naive Q16.16"], f"{row['function']}: {errors}")
    print("equal, damage is found, and no function is worse than it says")


if __name__ == "__main__":
    COMMAND, VECTORS = sys.argv[1], pathlib.Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as temporary:
        main(pathlib.Path(temporary))
