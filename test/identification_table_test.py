#!/usr/bin/python3
"""The aims below scripts/identification_table.py: of held-out figures only, and none is called reached that is not."""
import importlib.util
import pathlib
import unittest

PATH = pathlib.Path(__file__).resolve().parents[1] / "scripts" / "identification_table.py"
SPEC = importlib.util.spec_from_file_location("identification_table", PATH)
table = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(table)


def report(output, free_run, one_step, linear, validation=None):
    best = {"free_run": free_run, "one_step": one_step, "fit": 80.0}
    crossed = {"best": "state", "state": best, "regressors": None, "linear": dict(best, free_run=linear)}
    return {"cross_validation": {output: crossed}, "validation": validation}


class Aims(unittest.TestCase):
    def verdicts(self, name, told):
        return [cells[-1] for cells in table.aim_rows(name, told)]

    def test_each_aim_is_judged_by_its_own_figure(self):
        self.assertEqual(self.verdicts("tanks", report("y_V", 0.39, 0.051, 0.6)), ["reached", "not reached", "reached"])
        self.assertEqual(self.verdicts("tanks", report("y_V", 0.64, 0.049, 0.6)), ["not reached", "reached", "not reached"])

    def test_no_figure_is_not_reached(self):
        self.assertEqual(self.verdicts("tanks", report("y_V", None, None, 0.6)), ["not reached"] * 3)

    def test_later_rows_judge_where_there_are_any(self):
        figures = {"free_run": {"rmse": 0.2, "fit": 50.0}, "one_step": {"rmse": 0.1}}
        told = report("y", 0.05, 0.05, 0.3, {"y": dict(figures, linear=figures)})
        rows = list(table.aim_rows("drives_2", told))
        self.assertEqual([r[2] for r in rows], ["later rows"] * 2)
        self.assertEqual(rows[0][-1], "not reached")

    def test_linear_beside_itself_is_said(self):
        told = report("y", 0.3, 0.05, 0.3)
        told["cross_validation"]["y"]["best"] = "linear"
        self.assertEqual(self.verdicts("heating", told), ["reached (it is the linear model)"])

    def test_fit_is_better_when_higher(self):
        self.assertTrue(table.is_reached("fit", 97.5, 97.0))
        self.assertFalse(table.is_reached("fit", 96.9, 97.0))


class Page(unittest.TestCase):
    def test_tables_stand_between_their_marks(self):
        page = "before\n" + table.BEGIN + "\n\nold\n\n" + table.END + "\nafter\n"
        self.assertEqual(table.written(page, "new\n"), "before\n" + table.BEGIN + "\n\nnew\n\n" + table.END + "\nafter\n")

    def test_the_page_has_the_marks_once(self):
        page = table.PAGE.read_text(encoding="utf-8")
        self.assertEqual((1, 1), (page.count(table.BEGIN), page.count(table.END)))
        self.assertEqual(table.written(page, "x"), table.written(table.written(page, "y"), "x"))


if __name__ == "__main__":
    unittest.main()
