# SPDX-License-Identifier: GPL-3.0-or-later
"""The examples of the reference page and the cells of the notebook give what they show."""

import doctest
import json
import os
import unittest

SOURCE = os.environ["EOMGEN_SOURCE"]


class PageTest(unittest.TestCase):
    def test_examples_of_the_reference(self):
        flags = doctest.NORMALIZE_WHITESPACE
        found = doctest.testfile(f"{SOURCE}/docs/reference/python.md", module_relative=False, optionflags=flags)
        self.assertGreater(found.attempted, 30)
        self.assertEqual(found.failed, 0)


class NotebookTest(unittest.TestCase):
    def test_cells_show_what_the_notebook_has(self):
        with open(f"{SOURCE}/examples/notebook/pendulum.ipynb", encoding="utf-8") as file:
            notebook = json.load(file)
        names = {}
        cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
        self.assertGreater(len(cells), 4)
        for cell in cells:
            *lines, last = "".join(cell["source"]).rstrip().split("\n")
            shown = cell["outputs"][0]["data"] if cell["outputs"] else {}
            if not shown:
                exec("\n".join([*lines, last]), names)
                continue
            exec("\n".join(lines), names)
            value = eval(last, names)
            if "text/latex" in shown:
                self.assertEqual(value._repr_latex_(), "".join(shown["text/latex"]))
            elif "text/plain" in shown:
                self.assertEqual(repr(value), "".join(shown["text/plain"]))
            else:
                self.assertIn("<iframe", value._repr_html_())


if __name__ == "__main__":
    unittest.main()
