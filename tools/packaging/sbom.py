#!/usr/bin/env python3
"""Prints the list of contents (SBOM, SPDX 2.3) of a build: the project and the libraries that it was built with.

usage: sbom.py BUILD-FOLDER

Versions are those of the installed Debian packages; the date is SOURCE_DATE_EPOCH. The same build gives the same bytes.
"""

import datetime
import hashlib
import json
import os
import pathlib
import subprocess
import sys

# (Debian package, licence, relationship, where it ends up, the option that needs it)
LIBRARIES = [
    ("libxxhash-dev", "BSD-2-Clause", "STATIC_LINK", "headers, compiled into everything", None),
    ("libhwy-dev", "Apache-2.0", "STATIC_LINK", "headers, compiled into the core", "LOCKSTONE_WITH_HIGHWAY"),
    ("libenet-dev", "MIT", "DYNAMIC_LINK", "net, the C library, the command", "LOCKSTONE_WITH_ENET"),
    ("libsodium-dev", "ISC", "DYNAMIC_LINK", "net, replay, the C library, the command", "LOCKSTONE_WITH_SODIUM"),
    ("libwebsockets-dev", "MIT", "DYNAMIC_LINK", "net, the command", "LOCKSTONE_WITH_WEBSOCKETS"),
    ("libzstd-dev", "BSD-3-Clause", "DYNAMIC_LINK", "replay, the C library, the command", "LOCKSTONE_WITH_ZSTD"),
    ("libcli11-dev", "BSD-3-Clause", "STATIC_LINK", "headers, compiled into the command", None),
    ("libfmt-dev", "MIT", "STATIC_LINK", "headers, compiled into the command", None),
    ("nlohmann-json3-dev", "MIT", "STATIC_LINK", "headers, compiled into the command", None),
    ("libpng-dev", "Libpng", "DYNAMIC_LINK", "the command", "LOCKSTONE_WITH_ASSET_IMPORT"),
    ("libtinyobjloader-dev", "MIT", "STATIC_LINK", "headers, compiled into the command", "LOCKSTONE_WITH_ASSET_IMPORT"),
    ("libstdc++-12-dev", "GPL-3.0-or-later WITH GCC-exception-3.1", "STATIC_LINK", "the C library", None),
]


def cache_of(build):
    lines = (build / "CMakeCache.txt").read_text(encoding="utf-8").splitlines()
    entries = (line.partition("=") for line in lines if ":" in line.partition("=")[0])
    return {name.partition(":")[0]: value for name, _, value in entries}


def installed_version(package):
    done = subprocess.run(["dpkg-query", "-W", "-f=${Version}", package], capture_output=True, text=True)
    return done.stdout or None


def described(package, licence, where):
    version = installed_version(package)
    return {
        "SPDXID": "SPDXRef-" + package.replace("+", "p"),
        "name": package.removesuffix("-dev"),
        "versionInfo": version,
        "supplier": "Organization: Debian",
        "downloadLocation": "NOASSERTION",
        "licenseConcluded": licence,
        "comment": where,
        "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                          "referenceLocator": f"pkg:deb/debian/{package.replace('+', '%2B')}@{version}"}],
    }


def document(build):
    cache = cache_of(build)
    version = cache["CMAKE_PROJECT_VERSION"]
    used = [row for row in LIBRARIES
            if (row[4] is None or cache.get(row[4]) not in (None, "OFF")) and installed_version(row[0])]
    packages = [described(package, licence, where) for package, licence, _, where, _ in used]
    own = {"SPDXID": "SPDXRef-lockstone", "name": "lockstone", "versionInfo": version, "downloadLocation": "NOASSERTION",
           "supplier": "Organization: The Lockstone authors", "licenseConcluded": "MIT", "primaryPackagePurpose": "LIBRARY"}
    relations = [{"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES", "relatedSpdxElement": "SPDXRef-lockstone"}]
    relations += [{"spdxElementId": "SPDXRef-lockstone", "relationshipType": row[2],
                   "relatedSpdxElement": described(row[0], row[1], row[3])["SPDXID"]} for row in used]
    digest = hashlib.sha256(json.dumps([own, packages], sort_keys=True).encode()).hexdigest()
    date = datetime.datetime.fromtimestamp(int(os.environ.get("SOURCE_DATE_EPOCH", "0")), datetime.timezone.utc)
    return {
        "spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": f"lockstone-{version}",
        "documentNamespace": f"https://spdx.org/spdxdocs/lockstone-{version}-{digest[:32]}",
        "creationInfo": {"created": date.strftime("%Y-%m-%dT%H:%M:%SZ"), "creators": ["Tool: tools/packaging/sbom.py"]},
        "packages": [own, *packages], "relationships": relations,
    }


print(json.dumps(document(pathlib.Path(sys.argv[1])), indent=2))
