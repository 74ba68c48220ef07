"""conan create tools/packaging/conan --version 0.1.0: packages the checkout that this file lies in."""

import os

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy


class LockstoneConan(ConanFile):
    name = "lockstone"
    version = "0.1.0"
    license = "MIT"
    description = "Deterministic fixed-point lockstep physics core for networked games"
    topics = ("physics", "lockstep", "rollback", "deterministic", "fixed-point")
    package_type = "static-library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"net": [True, False], "security": [True, False], "compression": [True, False], "vectors": [True, False]}
    default_options = {"net": True, "security": True, "compression": True, "vectors": True}

    def export_sources(self):
        root = os.path.join(self.recipe_folder, "..", "..", "..")
        for pattern in ("CMakeLists.txt", "LICENSE", "core/*", "net/*", "replay/*", "tools/cmake/*"):
            copy(self, pattern, root, self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def requirements(self):
        self.requires("xxhash/0.8.2")
        if self.options.net:
            self.requires("enet/1.3.17")
        if self.options.security:
            self.requires("libsodium/1.0.18")
        if self.options.compression:
            self.requires("zstd/1.5.5")
        if self.options.vectors:
            self.requires("highway/1.0.3")

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        toolchain.variables["LOCKSTONE_WITH_ENET"] = bool(self.options.net)
        toolchain.variables["LOCKSTONE_WITH_SODIUM"] = bool(self.options.security)
        toolchain.variables["LOCKSTONE_WITH_ZSTD"] = bool(self.options.compression)
        toolchain.variables["LOCKSTONE_WITH_HIGHWAY"] = bool(self.options.vectors)
        toolchain.variables["LOCKSTONE_BUILD_TESTS"] = False
        toolchain.variables["LOCKSTONE_BUILD_TOOLS"] = False
        toolchain.variables["LOCKSTONE_INSTALL"] = True
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()

    def package_info(self):
        # The package brings its own configuration of CMake, with the components core, net and replay.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs.append(os.path.join("lib", "cmake", "lockstone"))
