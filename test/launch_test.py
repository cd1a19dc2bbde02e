#!/usr/bin/python3
"""Where the launch file writes, for names as people give them; without starting anything."""
import os
import pathlib
import unittest
import xml.etree.ElementTree

TOP = pathlib.Path(__file__).resolve().parent.parent

try:
    from roslaunch.substitution_args import resolve_args
except ImportError:
    resolve_args = None


@unittest.skipIf(resolve_args is None, "built without ROS")
class Folder(unittest.TestCase):
    def folder(self, out, loop="asp_case1"):
        tree = xml.etree.ElementTree.parse(TOP / "launch" / "loop.launch")
        value = next(a.get("value") for a in tree.iter("arg") if a.get("name") == "folder")
        return resolve_args(value, context={"arg": {"out": out, "loop": loop}})

    def test_an_absolute_folder_is_taken_as_it_is(self):
        self.assertEqual(self.folder("/tmp/a b"), "/tmp/a b")

    def test_a_relative_folder_is_below_the_folder_of_the_caller(self):
        os.environ["PWD"] = "/home/me"
        self.assertEqual(self.folder("a b"), "/home/me/a b")
        self.assertEqual(self.folder("./x"), "/home/me/./x")

    def test_no_folder_is_one_of_the_loop(self):
        home = os.environ["HOME"] + "/.ros/fmbpc/"
        self.assertEqual(self.folder(""), home + "asp_case1")
        self.assertEqual(self.folder("", "/some where/my loop.yaml"), home + "my loop")


if __name__ == "__main__":
    unittest.main()
