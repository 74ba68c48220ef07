"""Recipes and packages name the project's version and options that exist, and ship the files that they say.

usage: packaging_test.py ROOT VERSION BUILD-FOLDER
"""

import ast
import json
import os
import pathlib
import re
import subprocess
import sys
import unittest

ROOT, VERSION, BUILD = pathlib.Path(sys.argv[1]), sys.argv[2], pathlib.Path(sys.argv[3])
PACKAGING, BINDINGS = ROOT / "tools/packaging", ROOT / "tools/bindings"


def options():
    texts = [(ROOT / path).read_text() for path in ("CMakeLists.txt", "net/CMakeLists.txt", "replay/CMakeLists.txt")]
    return set(re.findall(r"(?:option|lockstone_optional)\((LOCKSTONE_\w+)", "".join(texts)))


class Recipes(unittest.TestCase):
    def test_have_the_projects_version(self):
        self.assertEqual(json.loads((PACKAGING / "vcpkg/ports/lockstone/vcpkg.json").read_text())["version-semver"], VERSION)
        self.assertIn(f'version = "{VERSION}"', (PACKAGING / "conan/conanfile.py").read_text())
        self.assertTrue((PACKAGING / "changelog").read_text().startswith(f"lockstone ({VERSION}) "))
        for crate in ("lockstone-sys", "lockstone"):
            self.assertIn(f'version = "{VERSION}"', (BINDINGS / "rust" / crate / "Cargo.toml").read_text())
        package = json.loads((BINDINGS / "csharp/com.lockstone.core/package.json").read_text())
        self.assertEqual(package["version"], VERSION)

    def test_set_options_that_exist(self):
        for path in ("vcpkg/ports/lockstone/portfile.cmake", "conan/conanfile.py"):
            named = set(re.findall(r"LOCKSTONE_\w+", (PACKAGING / path).read_text()))
            self.assertGreater(len(named), 5)
            self.assertEqual(named - options(), set(), path)

    def test_the_features_of_vcpkg_are_those_of_its_port(self):
        port = (PACKAGING / "vcpkg/ports/lockstone/portfile.cmake").read_text()
        manifest = json.loads((PACKAGING / "vcpkg/ports/lockstone/vcpkg.json").read_text())
        features = set(re.findall(r"^    (\w+) LOCKSTONE_", port, re.MULTILINE))
        self.assertEqual(features, set(manifest["features"]))
        self.assertEqual(features, set(manifest["default-features"]))

    def test_the_recipe_of_conan_exports_all_that_is_built(self):
        tree = ast.parse((PACKAGING / "conan/conanfile.py").read_text())
        text = ast.unparse(tree)
        for needed in ("CMakeLists.txt", "LICENSE", "core/*", "net/*", "replay/*", "tools/cmake/*"):
            self.assertIn(f"'{needed}'", text)


class Contents(unittest.TestCase):
    def list(self):
        environment = {**os.environ, "SOURCE_DATE_EPOCH": "1700000000"}
        command = [sys.executable, "-B", PACKAGING / "sbom.py", BUILD]
        return subprocess.run(command, check=True, capture_output=True, text=True, env=environment).stdout

    def test_are_listed_the_same_each_time(self):
        first = self.list()
        self.assertEqual(first, self.list())
        document = json.loads(first)
        self.assertEqual(document["creationInfo"]["created"], "2023-11-14T22:13:20Z")
        ids = [package["SPDXID"] for package in document["packages"]]
        self.assertEqual(len(set(ids)), len(ids))
        self.assertEqual(document["packages"][0]["versionInfo"], VERSION)
        self.assertEqual({relation["relatedSpdxElement"] for relation in document["relationships"]}, set(ids))

    def test_the_service_starts_the_command_with_options_that_it_has(self):
        unit = (PACKAGING / "systemd/lockstone@.service").read_text()
        container = (PACKAGING / "Containerfile").read_text()
        command = "".join((ROOT / path).read_text() for path in
                          ("tools/lockstone/match/serve_command.cpp", "tools/lockstone/support/output_file.h",
                           "tools/lockstone/support/output_file.cpp"))
        start = re.search(r"^ExecStart=(.*)$", unit, re.MULTILINE)[1] + re.search(r"ENTRYPOINT (.*)", container, re.DOTALL)[1]
        named = set(re.findall(r"--[a-z-]+", start)) - {"--help"}
        self.assertIn("--drain", named)
        for option in named:
            self.assertIn(f'"{option}"', command)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
