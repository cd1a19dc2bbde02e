"""Every script says what it is for: --help prints words and ends well, without ROS and without doing anything."""
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

TOP = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SCRIPTS = os.path.join(TOP, "scripts")
NOT_RUN = {"env.sh", "ccache.sh", "packages.txt", "fmbpc_completion.bash", "fmbpc", "exported_law.py", "live_view.py"}  # sourced, read, imported, or the tool


def programs():
    return [n for n in sorted(os.listdir(SCRIPTS)) if n not in NOT_RUN and os.path.isfile(os.path.join(SCRIPTS, n))]


class Scripts(unittest.TestCase):
    def test_help(self):
        self.assertGreater(len(programs()), 10)
        for name in programs():
            with self.subTest(name):
                with open(os.path.join(SCRIPTS, name), encoding="utf-8") as script:  # never run one that does not know it
                    text = script.read()
                self.assertTrue("--help" in text or "argparse" in text, "knows no --help")
                path = os.path.join(SCRIPTS, name)
                command = [path] if os.access(path, os.X_OK) else ["/usr/bin/python3", path]  # rosrun starts a relay of it
                done = subprocess.run([*command, "--help"], capture_output=True, text=True, timeout=60,
                                      env={"PATH": "/usr/bin:/bin", "HOME": os.environ.get("HOME", "/")}, check=False)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertGreater(len(done.stdout.split()), 5, done.stdout)

    def source_env(self, top, shell="bash"):
        done = subprocess.run([shell, "-c", f". '{top}/scripts/env.sh'; status=$?; command -v fmbpc; exit $status"], capture_output=True, text=True,
                              timeout=60, cwd="/", env={"PATH": "/usr/bin:/bin", "HOME": "/"}, check=False)
        return done.returncode, done.stdout + done.stderr

    def test_env_says_what_is_wrong_and_fails(self):
        with tempfile.TemporaryDirectory() as folder:
            top = pathlib.Path(os.path.realpath(folder)) / "tree"
            shutil.copytree(SCRIPTS, top / "scripts", symlinks=True)
            for shell, devel, words in (("sh", None, "is for bash"), ("bash", None, "not built yet"), ("bash", "/elsewhere" + str(top), "moved here"),
                                        ("bash", str(top), "tree/build/bin/fmbpc")):
                if devel:
                    (top / "devel").mkdir(exist_ok=True)
                    (top / "devel" / "setup.sh").write_text(f": ${{_CATKIN_SETUP_DIR:={devel}/devel}}\n")
                    (top / "devel" / "setup.bash").write_text("")
                status, text = self.source_env(top, shell)
                with self.subTest(words):
                    self.assertIn(words, text)
                    self.assertEqual(status == 0, words.endswith("fmbpc"))
            (pathlib.Path(folder) / "link").symlink_to(top)
            self.assertEqual(self.source_env(pathlib.Path(folder) / "link")[0], 0)

    def test_rosrun_finds_one_tool(self):
        """It follows links and leaves out nothing but build/."""
        found = [os.path.join(folder, name) for folder, _, names in os.walk(os.path.dirname(SCRIPTS), followlinks=True) for name in names
                 if name == "fmbpc" and not folder.startswith(os.path.join(os.path.dirname(SCRIPTS), "build"))]
        self.assertEqual(found, [os.path.join(SCRIPTS, "fmbpc")])

    def test_rosrun_finds_one_of_each_node_script(self):
        """catkin puts an executable relay of each into the devel space; where that lies inside the source tree, a second
        executable in scripts/ would make rosrun ask which is meant."""
        lists = re.search(r"^set\(scripts ([^)]*)\)", (pathlib.Path(TOP) / "CMakeLists.txt").read_text(encoding="utf-8"), re.M).group(1)
        relayed = lists.split()
        self.assertIn("scripts/soft_plc.py", relayed)
        for name in relayed:
            with self.subTest(name):
                self.assertFalse(os.stat(os.path.join(TOP, name)).st_mode & 0o111)

    def test_completion(self):
        """The names that bash offers, with a tool that knows two loops."""
        lines = """
        . %s/fmbpc_completion.bash
        fmbpc() { case "$1" in loops) printf 'asp_case1\\nasp_case2\\n' ;; --help) printf 'Subcommands:\\n  run  x\\n  resolve  x\\n' ;;
          run) printf -- '  --out TEXT\\n  --json\\n' ;;
          identify) printf -- '  -k, --kind TEXT:{best,linear}=best\\n  --blocks INT=4\\n  --json  all, as, one\\n' ;;
          tune) printf -- '  --method TEXT   apso, pso, de (default: the other)\\n' ;; esac; }
        try() { COMP_WORDS=(fmbpc "$@"); COMP_CWORD=$#; _fmbpc; echo "${COMPREPLY[*]}"; }
        cd /; try r; try run asp_case1; try run --o; try resolve asp
        try identify --kind l; try tune --method ''; try tune --method = ap; try identify --blocks ''; try resolve --json ''
        try replay ''; try replay x.bag asp_; try run --json asp_case1
        """ % SCRIPTS
        done = subprocess.run(["bash", "-c", lines], capture_output=True, text=True, timeout=60, check=True)
        both = "asp_case1 asp_case2"
        self.assertEqual(done.stdout.splitlines(), ["run resolve", "asp_case1", "--out", both,
                                                    "linear", "apso pso de", "apso", "", both, "", both, "asp_case1"],
                         done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()
