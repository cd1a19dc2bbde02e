#!/usr/bin/python3
"""The example of a user's package builds against an installed fmbpc and does there what its README says."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

TOP = pathlib.Path(__file__).resolve().parent.parent
BUILD = pathlib.Path(os.environ.get("FMBPC_BUILD", TOP / "build"))
WITH_ROS = "FMBPC_WITH_ROS:BOOL=ON" in (BUILD / "CMakeCache.txt").read_text()


def run(*command, check=True, **variables):
    done = subprocess.run([str(word) for word in command], env={**os.environ, **{k: str(v) for k, v in variables.items()}},
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=1800, check=False)
    if check and done.returncode != 0:
        raise AssertionError(f"{command}\n{done.stdout[-3000:]}")
    return done.stdout


def build(folder, target="all"):
    return run("cmake", "--build", folder, "--target", target, "--parallel", os.cpu_count())


class ExamplePackage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp())
        cls.fmbpc, cls.own = cls.folder / "fmbpc", cls.folder / "two tanks"
        run("cmake", "--install", BUILD, "--prefix", cls.fmbpc)
        shutil.copytree(TOP / "examples" / "two_tanks", cls.folder / "source")
        run("cmake", "-S", cls.folder / "source", "-B", cls.folder / "build", "-DCMAKE_BUILD_TYPE=Release",
            f"-DCMAKE_INSTALL_PREFIX={cls.own}", f"-DCATKIN_DEVEL_PREFIX={cls.folder}/devel",
            f"-DCMAKE_PREFIX_PATH={cls.fmbpc}", "-DTWO_TANKS_TEST=ON", "-DPYTHON_EXECUTABLE=/usr/bin/python3",
            "-DPython3_EXECUTABLE=/usr/bin/python3", CMAKE_PREFIX_PATH="")
        build(cls.folder / "build", "install")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def tool(self, *arguments, **variables):
        return run(self.fmbpc / "lib" / "fmbpc" / "fmbpc_tool", *arguments, CMAKE_PREFIX_PATH=self.own,
                   FMBPC_CONFIG_PATH=self.own / "share" / "two_tanks" / "config", LD_LIBRARY_PATH="", **variables)

    def summary(self, loop):
        with open(self.folder / "results" / loop / "summary.json", encoding="utf-8") as file:
            return json.load(file)

    def test_its_build_found_the_installed_targets(self):
        cache = (self.folder / "build" / "CMakeCache.txt").read_text()
        self.assertIn(f"fmbpc_DIR:PATH={self.fmbpc}", cache)
        self.assertTrue((self.own / "lib" / "libtwo_tanks.so").is_file())

    def test_its_own_test_passes(self):
        text = run("cmake", "--build", self.folder / "build", "--target", "test")
        self.assertIn("two_tanks_test", text)
        self.assertIn("100% tests passed", text)

    def test_the_public_headers_are_installed_and_enough(self):
        """They compile with Eigen and nothing of the source tree."""
        include = self.fmbpc / "include"
        listed = [str(p.relative_to(TOP / "include/fmbpc")) for p in (TOP / "include/fmbpc").rglob("*.hpp")]
        found = sorted(str(p.relative_to(include / "fmbpc")) for p in (include / "fmbpc").rglob("*.hpp"))
        self.assertEqual(sorted(listed), found)
        unit = self.folder / "all.cpp"
        unit.write_text("".join(f"#include <fmbpc/{header}>\n" for header in found))
        flags = re.findall(r"-isystem (\S+)", (self.folder / "build" / "CMakeFiles" / "two_tanks.dir" / "flags.make").read_text())
        self.assertIn(str(include), flags)
        self.assertNotIn(str(TOP / "include"), flags)
        compile_it = ["c++", "-std=c++17", "-fsyntax-only", *(word for folder in flags for word in ("-isystem", folder))]
        run(*compile_it, unit)
        for header in found if os.environ.get("FMBPC_LONG_TESTS") else []:  # each alone, a minute; check_core does it in the tree
            unit.write_text(f"#include <fmbpc/{header}>\n")
            run(*compile_it, unit)

    def test_the_tour_of_its_readme(self):
        results = self.folder / "results"
        self.tool("run", "two_tanks_outflow", "two_tanks_excite", "--no-plot", "--out", results)
        self.assertTrue(self.summary("two_tanks_outflow")["complete"])
        self.assertEqual(self.summary("two_tanks_excite")["steps"], 3600)
        model = self.folder / "model.yaml"
        report = json.loads(self.tool("identify", results / "two_tanks_excite" / "trajectory.csv", "two_tanks", "--out", model,
                                      "--json"))
        self.assertEqual(sorted(report["rules"]), ["h1", "h2"])
        self.tool("run", "two_tanks_fmbpc", "--no-plot", "--out", results / "two_tanks_fmbpc", TWO_TANKS_MODEL=model)
        predictive = self.summary("two_tanks_fmbpc")
        self.assertTrue(predictive["complete"])
        self.assertEqual((0, 0), (predictive["violations"]["input"], predictive["violations"]["move"]))

    @unittest.skipUnless(WITH_ROS, "a build without ROS")
    def test_a_workspace_of_both_packages_is_configured(self):
        """catkin_make makes the workspace's CMakeLists.txt; the targets of fmbpc are there before its export is."""
        source = self.folder / "ws" / "src"
        source.mkdir(parents=True)
        (source / "fmbpc").symlink_to(TOP)
        (source / "CMakeLists.txt").symlink_to("/usr/share/catkin/cmake/toplevel.cmake")
        shutil.copytree(TOP / "examples" / "two_tanks", source / "two_tanks")
        ws = self.folder / "ws"
        run("cmake", "-S", source, "-B", ws / "build", "-DCATKIN_ENABLE_TESTING=OFF", "-DPYTHON_EXECUTABLE=/usr/bin/python3",
            "-DPython3_EXECUTABLE=/usr/bin/python3", CMAKE_PREFIX_PATH="")
        link = (ws / "build" / "two_tanks" / "CMakeFiles" / "two_tanks.dir" / "link.txt").read_text()
        self.assertIn("libfmbpc_core.so", link)

    def need_module(self):
        if not WITH_ROS and not list((BUILD / "python" / "fmbpc").glob("_core.*")):
            self.skipTest("the module was not built")

    def test_the_python_package_is_in_the_prefix(self):
        """With everything that it needs, the tool and the loops included; with ROS the messages are in the same package."""
        self.need_module()
        code = ("import json, pathlib, fmbpc\n"
                "loop = fmbpc.Loop('asp_case1_clp', set={'sampling.duration_h': 4})\n"
                "maps = [line.split()[-1] for line in open('/proc/self/maps') if 'libfmbpc' in line]\n"
                "print(json.dumps([fmbpc.__file__, str(loop._core.file), *maps, loop.run().complete]))\n"
                + ("from fmbpc.msg import Measurement\n" if WITH_ROS else ""))
        where = {"PYTHONPATH": f"{self.fmbpc / 'lib/python3/dist-packages'}:{os.environ.get('PYTHONPATH', '') if WITH_ROS else ''}", "LD_LIBRARY_PATH": ""}
        *files, complete = json.loads(run("/usr/bin/python3", "-c", code, **where))
        self.assertTrue(complete)
        for file in files:
            self.assertTrue(file.startswith(str(self.fmbpc)), file)
        self.assertIn("asp_case1_clp", run("/usr/bin/python3", "-m", "fmbpc", "loops", **where))

    def test_python_steps_its_plant_and_runs_its_loops_as_the_tool(self):
        self.need_module()
        code = ("import sys, fmbpc\n"
                "fmbpc.register('two_tanks')\n"
                "plant = fmbpc.Plant('two_tanks')\n"
                "assert (plant.step() != plant.step({'q': 0.0})).any()\n"
                "fmbpc.Loop('two_tanks_outflow').run(progress=False).save(sys.argv[1])\n")
        where = {"PYTHONPATH": self.fmbpc / "lib/python3/dist-packages", "LD_LIBRARY_PATH": "", "CMAKE_PREFIX_PATH": self.own,
                 "FMBPC_CONFIG_PATH": self.own / "share" / "two_tanks" / "config"}
        results = self.folder / "of_python"
        run("/usr/bin/python3", "-c", code, results / "python", **where)
        self.tool("run", "two_tanks_outflow", "--no-plot", "--out", results / "tool")
        self.assertEqual(*((results / kind / "trajectory.csv").read_bytes() for kind in ("python", "tool")))

    def test_plant_and_controller_keep_what_every_one_promises(self):
        text = self.tool("check", "two_tanks")
        for subject in ("plant two_tanks", "controller outflow"):
            self.assertIn(subject, text)
        self.assertNotIn("BROKEN", text)
        self.assertNotEqual(0, subprocess.run([self.fmbpc / "lib" / "fmbpc" / "fmbpc_tool", "check", "nowhere"],
                                              capture_output=True, check=False).returncode)

    def test_the_arena_agrees_with_the_publications_of_its_plants(self):
        folder, own = self.folder / "arena_build", self.folder / "arena"
        run("cmake", "-S", TOP / "examples" / "arena", "-B", folder, "-DCMAKE_BUILD_TYPE=Release", f"-DCMAKE_INSTALL_PREFIX={own}",
            f"-DCATKIN_DEVEL_PREFIX={folder}/devel", f"-DCMAKE_PREFIX_PATH={self.fmbpc}", "-DARENA_TEST=ON",
            "-DPYTHON_EXECUTABLE=/usr/bin/python3", "-DPython3_EXECUTABLE=/usr/bin/python3", CMAKE_PREFIX_PATH="")
        build(folder, "install")
        self.assertIn("100% tests passed", build(folder, "test"))
        where = {"CMAKE_PREFIX_PATH": own, "FMBPC_TOOL": self.fmbpc / "lib" / "fmbpc" / "fmbpc_tool", "LD_LIBRARY_PATH": ""}
        self.assertNotIn("BROKEN", run(where["FMBPC_TOOL"], "check", "arena", **where))
        script = own / "lib" / "arena" / "arena"
        self.assertEqual(len(run(script, "list").split()), 9)
        run(script, "draw", "drum_level", "7", "--out", self.folder / "drum.yaml", **where)
        run(where["FMBPC_TOOL"], "run", self.folder / "drum.yaml", "--no-plot", "--out", self.folder / "drum", **where)

    def test_new_packages_build_and_their_tests_pass(self):
        for kind in ("plant", "controller"):
            name = f"my_{kind}"
            self.tool("new", kind, name, "--out", self.folder)
            folder = self.folder / f"{name}_build"
            run("cmake", "-S", self.folder / name, "-B", folder, f"-DCMAKE_PREFIX_PATH={self.fmbpc}",
                f"-DCATKIN_DEVEL_PREFIX={folder}/devel", "-DPYTHON_EXECUTABLE=/usr/bin/python3",
                "-DPython3_EXECUTABLE=/usr/bin/python3", CMAKE_PREFIX_PATH="")
            build(folder)
            tested = run("cmake", "-E", "chdir", folder, "ctest", "--output-on-failure", CMAKE_PREFIX_PATH="")
            self.assertIn("100% tests passed, 0 tests failed out of 2", tested)

    def test_lists_hold_what_it_brings(self):
        self.assertIn("outflow", self.tool("controllers"))
        self.assertIn("two_tanks", self.tool("plants"))

    def test_without_the_package_one_line_says_what_is_missing(self):
        text = run(self.fmbpc / "lib" / "fmbpc" / "fmbpc_tool", "run",
                   self.own / "share" / "two_tanks" / "config" / "loop" / "two_tanks_outflow.yaml", check=False,
                   CMAKE_PREFIX_PATH="", FMBPC_PLUGIN_PATH="")
        self.assertEqual(len(text.splitlines()), 1, text)
        for word in ("plugins", "'two_tanks'", "libtwo_tanks.so", "FMBPC_PLUGIN_PATH"):
            self.assertIn(word, text)


if __name__ == "__main__":
    sys.exit(unittest.main())
