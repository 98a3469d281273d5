#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The house test finds every kind of violation in small trees that have exactly one."""

import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import house_test

OPENING = "// SPDX-License-Identifier: Apache-2.0\n// What this file is for.\n"
GOOD = {
    "core/CMakeLists.txt": "# Pure.\nadd_layer(core\n  SOURCES scan.cpp)\n",
    "core/README.md": "Pure functions.\n",
    "core/scan.hpp": OPENING + "#include <vector>\nint beams();\n",
    "core/scan.cpp": OPENING + '#include "core/scan.hpp"\n#include <Eigen/Core>\n',
    "core/sim/CMakeLists.txt": "add_layer(sim SOURCES world.cpp USES core)\n",
    "core/sim/README.md": "Made-up worlds.\n",
    "core/sim/world.cpp": OPENING + '#include "core/scan.hpp"\n',
    "api/CMakeLists.txt": "add_layer(api SOURCES http.cpp USES core codecs LIBRARIES Threads)\n",
    "api/README.md": "REST.\n",
    "api/http.cpp": OPENING + '#include <mutex>\n#include <boost/asio.hpp>\n#include <sys/stat.h>\n'
                    '#include "adapters/codecs/json.hpp"\n#include "core/scan.hpp"\n',
    "adapters/codecs/CMakeLists.txt": "add_layer(codecs SOURCES json.cpp USES core)\n",
    "adapters/codecs/README.md": "Formats.\n",
    "adapters/codecs/json.hpp": OPENING + "#include <nlohmann/json.hpp>\n",
    "adapters/codecs/json.cpp": OPENING + '#include "adapters/codecs/json.hpp"\n',
    "tests/core/scan_test.cpp": OPENING + '#include <gtest/gtest.h>\n#include "core/scan.hpp"\n',
    "deploy/install": "#!/bin/sh\n# SPDX-License-Identifier: Apache-2.0\n# Installs everything.\n",
}


def found_in(changes: dict) -> list:
    """The violations of the good tree with some files changed, or None to be left out."""
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for file, text in {**GOOD, **changes}.items():
            if text is not None:
                (root / file).parent.mkdir(parents=True, exist_ok=True)
                (root / file).write_text(text)
        return list(house_test.violations(root))


class HouseTest(unittest.TestCase):
    def assert_one(self, file: str, line: int, words: str, text: str):
        found = found_in({file: text})
        self.assertEqual([(v.file, v.line) for v in found], [(file, line)], found)
        self.assertIn(words, found[0].text)

    def test_finds_nothing_in_a_good_tree(self):
        self.assertEqual(found_in({}), [])

    def test_finds_layers_that_are_not_declared(self):
        self.assert_one("core/scan.cpp", 3, "core does not declare that it USES api",
                        OPENING + '#include "api/http.hpp"\n')
        self.assert_one("adapters/codecs/json.cpp", 4, "USES sim",
                        OPENING + '\n#include "core/sim/world.hpp"\n')
        self.assert_one("core/scan.cpp", 3, "USES sim",
                        OPENING + '#  include "core/sim/world.hpp"\n')

    def test_an_outer_layer_does_not_lend_its_declarations_to_an_inner_one(self):
        self.assert_one("core/sim/world.cpp", 3, "sim does not declare that it USES api",
                        OPENING + '#include "api/http.hpp"\n')

    def test_finds_sources_and_includes_of_no_layer(self):
        found = found_in({"storage/sqlite.cpp": OPENING})
        self.assertEqual([(v.file, v.text) for v in found], [("storage/sqlite.cpp", "in no layer")])

    def test_finds_libraries_outside_their_owner(self):
        self.assert_one("api/http.cpp", 3, "belongs to adapters/codecs",
                        OPENING + "#include <nlohmann/json.hpp>\n")
        self.assert_one("adapters/codecs/json.hpp", 3, "belongs to storage",
                        OPENING + "#include <sqlite3.h>\n")
        self.assert_one("core/scan.cpp", 3, "belongs to api",
                        OPENING + "#include <boost/asio/post.hpp>\n")
        self.assert_one("core/scan.cpp", 3, "no owner", OPENING + "#include <fmt/core.h>\n")

    def test_finds_what_is_not_pure_in_core(self):
        for line in ("#include <fstream>", "#include <thread>", "#include <unistd.h>",
                     "auto t = std::chrono::steady_clock::now();", "std::random_device seed;",
                     'std::printf("%d", 1);'):
            self.assert_one("core/scan.cpp", 3, "core is pure", OPENING + line + "\n")
            self.assert_one("core/sim/world.cpp", 3, "core is pure", OPENING + line + "\n")

    def test_does_not_take_words_of_comments_and_literals_for_code(self):
        code = OPENING + '// never ::now()\nauto s = "std::random_device";  /* getenv */\n'
        self.assertEqual(found_in({"core/scan.cpp": code}), [])

    def test_finds_missing_openings(self):
        self.assert_one("core/scan.cpp", 1, "SPDX", "// What this is for.\nint x;\n")
        self.assert_one("core/scan.cpp", 2, "what the file is for",
                        OPENING.split("\n")[0] + "\n#pragma once\n")
        self.assert_one("core/scan.cpp", 1, "SPDX", "")
        self.assert_one("deploy/install", 2, "SPDX", "#!/bin/sh\necho 1\n")

    def test_finds_long_lines_and_files(self):
        self.assertEqual(found_in({"core/scan.cpp": OPENING + "//" + 98 * "x" + "\n"}), [])
        self.assert_one("core/scan.cpp", 3, "101 columns", OPENING + "//" + 99 * "x" + "\n")
        self.assertEqual(found_in({"core/scan.cpp": OPENING + 398 * "\n"}), [])
        self.assert_one("core/scan.cpp", 401, "400 lines", OPENING + 399 * "\n")

    def test_finds_unwanted_words(self):
        for line in ("class RobotManager;", "struct JsonHelper {};", "// TODO later",
                     "using namespace std;"):
            self.assert_one("core/scan.cpp", 3, "unwanted", OPENING + line + "\n")

    def test_finds_layers_without_a_reason(self):
        found = found_in({"api/README.md": None})
        self.assertEqual([v.file for v in found], ["api/README.md"])

    def test_does_not_pass_a_tree_in_which_it_sees_nothing(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(len(list(house_test.violations(Path(folder)))), 1)

    def test_finds_long_functions(self):
        self.assertEqual(found_in({"core/scan.cpp": OPENING + function("int f()", 60)}), [])
        self.assert_one("core/scan.cpp", 3, "61 lines", OPENING + function("int f()", 61))
        self.assert_one("tests/core/scan_test.cpp", 4, "61 lines",
                        OPENING + "\n" + function("TEST(Scan, Is)", 61))


def function(head: str, lines: int) -> str:
    return head + " {\n" + (lines - 2) * "  g();\n" + "}\n"


class FunctionsTest(unittest.TestCase):
    def assert_lines(self, code: str, *lines: int):
        self.assertEqual([f.lines for f in house_test.functions(code)], list(lines), code)

    def test_measures_from_the_signature_to_the_closing_brace(self):
        self.assert_lines("int f(int a,\n      int b) {\n  return a;\n}\n", 4)
        self.assert_lines("namespace a::b {\n\n" + function("int f()", 5) + "}\n", 5)

    def test_measures_members_and_not_their_class(self):
        self.assert_lines("class A : public B {\n public:\n  A(int a)\n      : a_{a}, b_(2) {\n"
                          "    g();\n  }\n  int f() const { return 1; }\n  int a_ = 0;\n};\n", 4, 1)
        self.assert_lines("template <int (*f)(int)>\nstruct A {\n  T f() {\n  }\n};\n", 2)
        self.assert_lines("struct A f(int a) {\n}\nenum class E : int { a, b };\n", 2)

    def test_counts_blocks_and_lambdas_as_part_of_their_function(self):
        self.assert_lines("int f() {\n  if (a) {\n  } else {\n  }\n"
                          "  auto g = [](int i) {\n    return i;\n  };\n}\n", 8)
        self.assert_lines("const auto f = [](int i) {\n  return i;\n};\n", 3)

    def test_does_not_take_tables_for_functions(self):
        self.assert_lines("constexpr Route kRoutes[] = {\n  {1, &f},\n};\nint g() {\n}\n", 2)

    def test_is_not_led_astray_by_braces_in_literals_comments_and_macros(self):
        self.assert_lines("int f() {\n  // {\n  char c = '{'; s = \"{\"; n = 1'000;\n"
                          "  t = R\"x({)\" {)x\"; /* {\n */\n}\n", 6)
        self.assert_lines("#define A \\\n  {\nint g() {\n#if A  // {\n}\n", 3)


if __name__ == "__main__":
    unittest.main()
