"""An assertion that does not hold: test/counting_test.py runs it to see that the count notices."""
import unittest


class Broken(unittest.TestCase):
    def test_assertion_that_does_not_hold(self):
        self.assertEqual(1, 2)
