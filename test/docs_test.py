#!/usr/bin/python3
"""What people read holds together: links lead somewhere, sources that are cited by key are in docs/references.bib, the README
stays a page."""
import hashlib
import os
import pathlib
import re
import unittest

TOP = pathlib.Path(__file__).resolve().parent.parent
PAGES = [TOP / "README.md", TOP / "CONTRIBUTING.md", *sorted((TOP / "docs").glob("*.md")), *sorted((TOP / "examples").rglob("*.md"))]
LINK = re.compile(r"\]\(([^)\s]+)\)")
KEY = re.compile(r"\b([a-z]{3,}(?:19|20)\d\d[a-z]?|vallejo2021thesis|mekki)\b(?=[\])};:,. ]|$)", re.MULTILINE)
FREE = re.compile(r"\b(?!COST|Debian|Ubuntu|Eigen|SUNDIALS)[A-Z][a-z']+(?: et al\.|(?:, [A-Z][a-z]+)* and(?: [A-Z]\w+)+)?,? \(?(?:19|20)\d\d\b")
FENCED = re.compile(r"^```.*?^```|^    .*?$", re.MULTILINE | re.DOTALL)
STUDY = re.compile(r"fmbpc study\s+(\w+(?:`, `\w+|`,\s+`\w+)*)")
SOURCE = re.compile(r"fmbpc (?:study|reproduce)\s+\w+|test/\w[\w/]*\.cpp")  # what makes a table
CONFIG = sorted((TOP / "config").rglob("*.yaml"))


def anchors(page):
    """Anchors of a page's headings, as they are made on the web."""
    heads = re.findall(r"^#+ (.*)$", page.read_text(), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", head.lower()).strip().replace(" ", "-") for head in heads}


def keys_of_the_list():
    return set(re.findall(r"^@\w+\{(\w+),", (TOP / "docs/references.bib").read_text(), re.MULTILINE))


class Docs(unittest.TestCase):
    def test_links_lead_somewhere(self):
        for page in PAGES:
            for link in LINK.findall(page.read_text()):
                if "://" in link:
                    continue
                file, _, anchor = link.partition("#")
                target = (page.parent / file).resolve() if file else page
                self.assertTrue(target.exists(), f"{page.name} links to {link}")
                if anchor and target.suffix == ".md":
                    self.assertIn(anchor, anchors(target), f"{page.name} links to {link}")

    def test_sources_are_in_the_list(self):
        known = keys_of_the_list()
        self.assertGreater(len(known), 20)
        texts = PAGES + CONFIG + [p for folder in ("include", "src") for p in sorted((TOP / folder).rglob("*.?pp"))]
        cited = {}
        for path in texts:
            for line in path.read_text().splitlines():
                if path.suffix in (".md", ".yaml") or "//" in line:
                    for key in KEY.findall(line if path.suffix in (".md", ".yaml") else line.partition("//")[2]):
                        cited.setdefault(key, path)
        unknown = {key: str(path) for key, path in cited.items() if key not in known}
        self.assertEqual({}, unknown)
        self.assertGreater(len(cited), 10)

    def test_code_cites_by_key(self):
        """Not by names and years, which nobody can look up; a comment's lines are read as one text."""
        for folder in ("include", "src", "test"):
            for path in sorted((TOP / folder).rglob("*.?pp")):
                words = " ".join(line.partition("//")[2].strip("/ ") for line in path.read_text().splitlines())
                self.assertIsNone(FREE.search(words), f"{path}: {FREE.findall(words)}")
        for path in CONFIG + sorted((TOP / "src" / "plant").rglob("*.cpp")):
            words = " ".join(line.strip("# ") for line in path.read_text().splitlines())
            self.assertIsNone(FREE.search(words), f"{path}: {FREE.findall(words)}")

    def test_articles_have_a_doi_or_no_year(self):
        entries = re.findall(r"^@article\{(\w+),(.*?)(?=^@|\Z)", (TOP / "docs/references.bib").read_text(), re.MULTILINE | re.DOTALL)
        without = {key for key, text in entries if "doi" not in text and "year" in text}
        self.assertLessEqual(without, {"rieger2003", "vallejo2026", "vinante1972"})

    def test_studies_that_are_named_ship(self):
        for page in PAGES:
            for names in STUDY.findall(page.read_text()):
                for name in re.findall(r"\w+", names):
                    known = (TOP / "config/study" / f"{name}.yaml").exists() or list((TOP / "config/loop").rglob(f"{name}.yaml"))
                    self.assertTrue(known, f"{page.name}: fmbpc study {name}")

    def test_every_table_of_comparisons_says_what_makes_it(self):
        """In the words before it, since the table before or the heading."""
        for page in sorted((TOP / "docs").glob("comparisons*.md")):
            before, cells = [], ""
            for line in page.read_text().split("## In short")[-1].partition("\n## ")[2].splitlines():
                if line.startswith("#"):
                    before = []
                elif line.startswith("|---"):
                    self.assertRegex(" ".join([*before, cells]), SOURCE, page)
                    before = []
                elif line.startswith("|"):
                    cells = line
                else:
                    before.append(line)

    def test_the_page_of_records_is_the_list_that_errors_quote(self):
        listed = re.findall(r"^(\w+\.csv):\n  from: (.*)\n  sha256: (\w{64})$", (TOP / "config/records.yaml").read_text(), re.MULTILINE)
        page = re.findall(r"^\| `(\w+\.csv)` .*\| (.*) \| `(\w{64})` \|$", (TOP / "docs/records.md").read_text(), re.MULTILINE)
        self.assertGreater(len(listed), 10)
        self.assertEqual(listed, page)
        folder = os.environ.get("FMBPC_DATA")
        for name, _, checksum in listed if folder else ():
            self.assertEqual(checksum, hashlib.sha256((pathlib.Path(folder) / name).read_bytes()).hexdigest(), name)

    def test_what_the_readme_runs_is_there(self):
        """Commands in its code blocks: the tool's, scripts, launch files, loops, tunings and files."""
        tool = (TOP / "src/tool/main.cpp").read_text() + "".join(p.read_text() for p in sorted((TOP / "src/tool").glob("*.cpp")))
        loops = {p.stem for p in (TOP / "config/loop").rglob("*.yaml")} | {p.stem for p in (TOP / "config/tuning").glob("*.yaml")}
        lines = [line.split("#")[0].strip() for line in re.findall(r"^    (\S.*)$", (TOP / "README.md").read_text(), re.MULTILINE)]
        commands = [line.split() for line in lines if re.match(r"(fmbpc|roslaunch|scripts/)", line)]
        self.assertGreater(len(commands), 8)
        for words in commands:
            if words[0] == "fmbpc":
                self.assertRegex(tool, rf'"{words[1]}"', words)
            for word in words[1:]:
                name = word[len("loop:="):] if word.startswith("loop:=") else word
                if "_" in name and re.fullmatch(r"[a-z0-9_]+", name):
                    self.assertTrue(name in loops or name in {"q_c", "d_q_c"}, words)
                if re.fullmatch(r"examples/\S+", word):
                    self.assertTrue((TOP / word).exists(), words)
            if words[0].startswith("scripts/"):
                self.assertTrue((TOP / words[0]).exists(), words)

    def test_the_readme_is_a_page(self):
        self.assertLessEqual(len((TOP / "README.md").read_text().splitlines()), 120)


if __name__ == "__main__":
    unittest.main()
