"""Conan 2 recipe: the core and the C interface of the checkout that it is in."""

import os
import re

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load


class Mobil(ConanFile):
    name = "mobil"
    description = "Crowds of people who walk, and whose leg muscles deform as they do"
    license = "MIT"
    settings = "os", "arch", "compiler", "build_type"
    package_type = "library"
    requires = "eigen/3.4.0", "fmt/[>=9 <12]", "highway/[>=1.0.3 <2]", "tl-expected/[>=1.0 <2]"

    @property
    def _root(self):
        return os.path.join(self.recipe_folder, "..", "..", "..")

    def set_version(self):
        text = load(self, os.path.join(self._root, "CMakeLists.txt"))
        self.version = re.search(r"project\(mobil VERSION ([\d.]+)", text)[1]

    def export_sources(self):
        for part in ("CMakeLists.txt", "LICENSE", "components/*", "engine/*", "assets/*", "systems/*", "demo/*", "tests/*"):
            copy(self, part, self._root, self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        for part in ("IMPORT", "EXPORT", "RENDER", "CLUSTER", "PROGRAM", "TESTS"):
            toolchain.cache_variables[f"MOBIL_{part}"] = False
        toolchain.cache_variables["CMAKE_COMPILE_WARNING_AS_ERROR"] = False
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))

    def package_info(self):
        self.cpp_info.set_property("cmake_find_mode", "none")  # mobil installs its own configuration
        self.cpp_info.builddirs = [os.path.join("lib", "cmake", "mobil")]
