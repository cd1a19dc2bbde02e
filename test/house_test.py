#!/usr/bin/python3
"""The house rules that a compiler does not check: who may include whom, and which clocks may be read."""
import pathlib
import re
import unittest

TOP = pathlib.Path(__file__).resolve().parent.parent
ROS_INCLUDE = re.compile(r'#include *[<"](ros/\w+\.h[>"]|tf2|std_msgs|std_srvs|rosgraph|geometry_msgs|diagnostic|actionlib|dynamic_reconfigure|fmbpc/[A-Z])')
ROS_CLOCK = re.compile(r"ros::Time::now|create(Steady|Wall)?Timer|ros::(Steady|Wall)?Timer\b|ros::Rate|ros::Duration\([^)]*\)\.sleep|rospy\.(Rate|sleep|Timer|get_rostime|Time\.now)")
RANKS = {"base": 0, "optim": 1, "model": 2, "plant": 3, "estimation": 3, "identification": 3, "control": 4, "supervision": 5, "analysis": 5, "config": 6, "runtime": 7,
         "study": 8, "export": 8, "ros": 8}
FORBIDDEN = {("plant", "optim"), ("supervision", "plant"), ("control", "plant"), ("control", "identification"), ("analysis", "plant")}


def sources(*folders):
    for folder in folders:
        for path in sorted((TOP / folder).rglob("*")):
            if path.suffix in (".cpp", ".hpp") and path.is_file():
                yield path


def types_of(text):
    """Types that are defined at namespace scope, as a::b::Name; not those of unnamed namespaces."""
    text = re.sub(r'//[^\n]*|/\*.*?\*/|R"\w*\(.*?\)\w*"|"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)\'', "", text, flags=re.S)
    scopes, found, last = [], [], 0
    for brace in re.finditer(r"[{}]", text):
        head = text[last:brace.start()].rsplit(";", 1)[-1].strip()
        last = brace.end()
        if brace.group() == "}":
            scopes = scopes[:-1]
            continue
        space = re.search(r"namespace\s*([\w:]*)$", head)
        named = re.search(r"(?:^|\s)(?:struct|class|enum class)\s+(\w+)(?:\s+final)?(?:\s*:[^:].*)?$", head, flags=re.S)
        if named and None not in scopes and "template" not in head and "enum" not in head:
            found.append("::".join(scopes + [named.group(1)]))
        scopes = scopes + [space.group(1) if space and space.group(1) else None]
    return found


def controller_types():
    """The file of the registration by controller.type."""
    named = re.compile(r'(?:ControllerType type\{|\{\{)"(\w+)"')
    found = {name: p for p in sources("src/control") if p.name.endswith("_type.cpp") for name in named.findall(p.read_text())}
    assert len(found) >= 8, found
    return found


def plant_types():
    text = "\n".join(p.read_text() for p in sources("src/plant"))
    found = re.findall(r'registerPlant\(\s*"(\w+)"', text)
    found += re.findall(r'"(\w+)"', re.search(r"char\* const names\[\] = \{([^}]*)\}", text)[1])  # those of bsm1
    assert len(found) >= 10, found
    return found


def named_by_others(types, room):
    """Files that name one of these types as a literal, outside of its room, the papers' reproductions and the studies of scripts/."""
    literal = re.compile(r'["\'](' + "|".join(types) + r')["\']')
    paths = [p for p in sources("include", "src") if room_of(p) != room and room_of(p) != "papers"]
    paths += sorted((TOP / "launch").glob("*")) + sorted((TOP / "cmake").glob("*"))
    return [str(p) for p in paths if literal.search(p.read_text())]


def room_of(path):
    parts = path.relative_to(TOP).parts
    return parts[2] if parts[0] == "include" else parts[1]


class House(unittest.TestCase):
    def test_the_core_includes_no_ros_header(self):
        core = [p for p in sources("include", "src") if room_of(p) not in ("ros", "nodes") and p != TOP / "src/precompiled/ros.hpp"]
        self.assertGreater(len(core), 20)
        for path in core:
            self.assertIsNone(ROS_INCLUDE.search(path.read_text()), path)

    def test_public_headers_are_free_of_ros(self):
        """Classes of nodes are private: src/ros."""
        self.assertEqual([], [p for p in sources("include") if room_of(p) == "ros"])

    def test_rooms_include_only_rooms_below_them(self):
        for path in sources("include", "src"):
            room = room_of(path)
            if room not in RANKS:
                continue
            for other in re.findall(r'#include "(?:fmbpc/)?(\w+)/', path.read_text()):
                if other in RANKS and other != room:
                    self.assertLess(RANKS[other], RANKS[room], f"{path} includes {other}/")
                    self.assertNotIn((room, other), FORBIDDEN, f"{path} includes {other}/")

    def test_no_room_looks_into_the_parameters_of_one_type(self):
        """What the house must know of a type the type registers."""
        for path in sources("src/config", "src/runtime", "src/study", "src/ros"):
            if path.suffix == ".cpp":
                self.assertNotIn("findParams<", path.read_text(), path)

    def test_types_of_controllers_and_plants_are_compared_nowhere(self):
        """Everything learns of them from the registry; their names stand in their own registration."""
        names = "|".join(sorted(controller_types()) + plant_types())
        compared = re.compile(rf'[=!]= *"({names})"|"({names})" *[=!]=')
        for path in sources("include", "src", "test"):
            self.assertIsNone(compared.search(path.read_text()), path)

    def test_a_type_of_controller_is_four_files_beside_the_law_and_its_test(self):
        """The registration, its line for CMake, a loop, its keys: docs/own_controller.md lists them; nobody else may have to know."""
        where = (TOP / "docs/own_controller.md").read_text().split("## Where the files go")[1]
        listed = re.findall(r"^\| `([^`]+)` \|", where, flags=re.M)
        self.assertEqual(listed, ["src/control/FAMILY/my_type.cpp", "src/CMakeLists.txt", "config/loop/PLANT/PLANT_my.yaml", "docs/loop_controller.md"])
        loops = "\n".join(path.read_text() for path in (TOP / "config/loop").rglob("*.yaml"))
        for name, registration in controller_types().items():
            self.assertIn(f" control/{registration.parent.name}/{registration.name}\n", (TOP / "src/CMakeLists.txt").read_text())
            self.assertRegex(loops, rf"(?m)^  type: {name}\b")
            self.assertRegex((TOP / "docs/loop_controller.md").read_text(), rf"`[^`\n]*\b{name}\b[^`\n]*`")
        # "fmbpc" is the package as well, "pi" a key of the section guard
        self.assertEqual([], named_by_others(set(controller_types()) - {"fmbpc", "pi"}, "control"))

    def test_a_type_of_plant_is_known_to_no_other_file_of_the_library(self):
        self.assertEqual([], named_by_others(plant_types(), "plant"))

    def test_every_timer_of_a_node_is_guarded(self):
        """Whatever is thrown in a timer ends the process: they are made by Node::guardedTimer(), or call callGuarded()."""
        own = ("steady_timer.hpp", "steady_timer.cpp")
        made = [(p, m) for p in sources("src/ros") if p.name not in own for m in re.finditer(r"\bSteadyTimer\(", p.read_text())]
        self.assertEqual({"node.hpp", "health_reporter.cpp", "diagnostics.cpp", "plant_host.cpp"}, {p.name for p, _ in made})
        for path, match in made:
            self.assertRegex(path.read_text()[match.end():][:400], r"\b(callGuarded|guarded)\(", path)

    def test_our_nodes_never_read_the_ros_clock(self):
        paths = list(sources("include", "src")) + sorted((TOP / "scripts").glob("*.py"))
        for path in paths:
            self.assertIsNone(ROS_CLOCK.search(path.read_text()), path)

    def test_sundials_stays_in_the_files_of_the_integrators(self):
        users = [p.name for p in sources("include", "src") if re.search(r"#include *<(cvode|sundials|nvector|sun\w+/)", p.read_text())]
        self.assertEqual(sorted(users), ["cvode.cpp"])

    def test_no_public_header_shows_yaml_or_json(self):
        for path in sources("include"):
            self.assertIsNone(re.search(r"#include *<(yaml-cpp|nlohmann)", path.read_text()), path)

    def test_no_two_types_share_a_name(self):
        """Two types of one name in one namespace are undefined behaviour: the linker keeps one of their constructors."""
        places = {}
        for path in sources("include", "src"):
            for name in types_of(path.read_text()):
                places.setdefault(name, set()).add(str(path.relative_to(TOP)))
        twice = {name: sorted(files) for name, files in places.items() if len(files) > 1}
        self.assertEqual(twice, {})

    def test_types_are_told_by_their_namespace(self):
        text = "namespace a {\nnamespace {\nstruct X {\n};\n}  // namespace\nstruct Y final : Z {\n};\nstruct F;\n}\nstruct X {\n};\n"
        self.assertEqual(types_of(text), ["a::Y", "X"])

    def test_words_are_those_of_the_field(self):
        """Innovation, observer, baseline, unclipped, missing: not what a program thinks, believes or wants."""
        words = re.compile(r"\b(think\w*|lacking|wanted|belie[fv]\w*)\b|_wanted|wanted_|(?<!ar)rival", re.IGNORECASE)
        paths = list(sources("include", "src", "test", "bench")) + sorted((TOP / "docs").glob("*.md"))
        for path in paths:
            self.assertIsNone(words.search(path.read_text()), f"{path}: {words.findall(path.read_text())}")
            self.assertIsNone(words.search(path.name), path)

    def test_small_questions_about_signals_are_answered_once(self):
        again = re.compile(r"\b(?:countOf|signalCount|allFinite)\(const (?:std::vector<\w[\w:]*>|Measurement)& \w+\) *\{|\bnamesOf\(const [\w:<>]+& \w+\) *\{")
        places = [p for p in sources("include", "src", "bench") if again.search(p.read_text())]
        self.assertEqual([TOP / "include/fmbpc/base/signals.hpp"], places)
        infinity = re.compile(r"\bk\w+ = -?std::numeric_limits<double>::infinity\(\)")
        places = [p for p in sources("include", "src", "test") if infinity.search(p.read_text())]
        self.assertEqual([TOP / "include/fmbpc/base/types.hpp"], places)

    def test_mains_are_short(self):
        for path in sources("src/nodes"):
            body = path.read_text().split("int main", 1)[1]
            self.assertLessEqual(len(body.splitlines()), 20, path)


if __name__ == "__main__":
    unittest.main()
