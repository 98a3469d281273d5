#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Keeps the house rules: who includes whom, who owns which library, and how a file looks.

tests/house_test.py [ROOT] prints every violation as file:line: text and exits with 1 if there are
any. The layers are read from the add_layer() calls of the CMakeLists.txt files.
"""

import re
import sys
from pathlib import Path
from typing import Iterator, NamedTuple, Optional

FOLDERS = ("core", "adapters", "storage", "api", "service", "tests", "deploy", ".ci")
SKIPPED = {"build", "node_modules", "__pycache__", "demo-out"}
MAX_COLUMNS = 100
MAX_FILE_LINES = 400
MAX_FUNCTION_LINES = 60

# Which folder a third-party header may be included from, by prefix.
OWNERS = {
    "Eigen/": "core", "hwy/": "core", "boost/math/": "core",
    "nlohmann/": "adapters/codecs", "simdjson": "adapters/codecs",
    "mqtt/": "adapters/mqtt", "MQTT": "adapters/mqtt",
    "zlib.h": "adapters/logs", "bzlib.h": "adapters/logs",
    "sqlite3": "storage", "zstd": "storage",
    "boost/asio": "api", "boost/beast": "api", "boost/system": "api",
    "openssl/": "api storage",
    "prometheus/": "api",
    "CLI/": "service", "toml++/": "service", "spdlog/": "service", "systemd/": "service",
}
SYSTEM = re.compile(
    r"[a-z0-9_]+|(sys|netinet|arpa|net|linux)/\w+\.h"
    r"|(unistd|fcntl|signal|poll|pthread|sched|errno|time|termios|netdb|spawn|dlfcn|immintrin)\.h")

# What core must do without: input, output, threads, clocks, chance that no seed decides.
IMPURE_HEADERS = set(
    "iostream istream ostream fstream cstdio filesystem syncstream thread mutex shared_mutex "
    "future condition_variable semaphore latch barrier stop_token atomic csignal ctime".split())
IMPURE_CALLS = re.compile(r"::now\s*\(|\brandom_device\b|\bgetenv\b|\bv?f?printf\s*\(")

FORBIDDEN = re.compile(
    r"\b(?:TODO|FIXME|XXX|HACK)\b|\busing namespace std;"
    r"|\b(?:class|struct)\s+\w*(?:Manager|Handler|Helper|Utils?|Factory|Registry)\b")


class Violation(NamedTuple):
    file: str
    line: int
    text: str


class Layer(NamedTuple):
    name: str
    folder: str
    uses: frozenset


class Function(NamedTuple):
    first_line: int
    lines: int


def files_of(root: Path) -> Iterator[Path]:
    """Every file of the project, in order."""
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.is_file() and not SKIPPED & set(path.relative_to(root).parts):
                yield path


def layers_of(root: Path) -> list:
    """The layers that the CMakeLists.txt files declare."""
    layers = []
    for path in files_of(root):
        if path.name != "CMakeLists.txt" or "tests" in path.relative_to(root).parts:
            continue
        text = re.sub(r"#.*", "", path.read_text())
        for call in re.findall(r"\badd_layer\s*\(([^)]*)\)", text):
            name, words, key = call.split()[0], {}, ""
            for word in call.split()[1:]:
                key = word if word in ("SOURCES", "USES", "LIBRARIES") else key
                words.setdefault(key, []).append(word)
            folder = path.parent.relative_to(root).as_posix()
            layers.append(Layer(name, folder, frozenset(words.get("USES", [])[1:])))
    return layers


def layer_at(layers: list, file: str) -> Optional[Layer]:
    """The layer with the innermost folder around `file`."""
    around = [layer for layer in layers if file.startswith(layer.folder + "/")]
    return max(around, key=lambda layer: len(layer.folder), default=None)


def bare(code: str) -> str:
    """C++ without comments, directives and literals; lines stay where they are."""
    tokens = (r"//[^\n]*|/\*.*?\*/|^[ \t]*#(?:\\\n|[^\n])*"
              r'|R"(?P<end>[^(\s]*)\(.*?\)(?P=end)"|"(?:\\.|[^"\\\n])*"'
              r"|(?<![0-9A-Fa-f])'(?:\\.|[^'\\\n])*'")
    return re.sub(tokens, lambda token: "\n" * token.group().count("\n"), code,
                  flags=re.S | re.M)


def includes(code: str) -> Iterator[tuple]:
    """(line, header, whether it is the project's own) of every #include."""
    for number, line in enumerate(code.split("\n"), 1):
        found = re.match(r'\s*#\s*include\s*(?:"([^"]+)"|<([^>]+)>)', line)
        if found:
            yield number, found[1] or found[2], found[1] is not None


def functions(code: str) -> Iterator[Function]:
    """Every function with a body, lambdas and local ones as part of the one around them.

    A brace opens a function if the statement before it has a parameter list and all braces around
    it are those of namespaces and classes.
    """
    blocks, statement, begin, line = [], "", 1, 1
    code = bare(code)
    for at, char in enumerate(code):
        line += char == "\n"
        if char == "{":
            blocks.append((kind_of_block(statement, blocks), begin))
            statement = ""
        elif char == "}" and blocks:
            kind, first_line = blocks.pop()
            if re.match(r"\s*[,{.(]", code[at + 1:at + 80]):  # of an initialiser: f() : a{1} {}
                statement, begin = "()", first_line
            elif kind == "function":
                yield Function(first_line, line - first_line + 1)
        elif char == ";" or re.fullmatch(r"public|protected|private", statement.strip()):
            statement = ""
        elif statement or not char.isspace():
            begin = begin if statement else line
            statement += char


def kind_of_block(statement: str, around: list) -> str:
    """What a brace after `statement` opens."""
    if any(kind != "container" for kind, _ in around):
        return "inside"
    words = r"(?:template\s*<.*>\s*|inline\s+)*(?:namespace|class|struct|union|enum|extern)\b"
    if re.match(words, statement, re.S) and not re.search(r"[)=]\s*(?:const)?\s*$", statement):
        return "container"
    return "function" if "(" in statement else "inside"


def include_violations(file: str, code: str, layers: list) -> Iterator[Violation]:
    """Layers and libraries that `file` may not include."""
    own = layer_at(layers, file)
    allowed = (own.uses | {own.name}) if own else {"core"}
    for line, header, is_own in includes(code):
        if is_own:
            other = layer_at(layers, header)
            if other and other.name not in allowed:
                yield Violation(file, line, f"{own.name if own else 'no layer'} does not declare "
                                            f"that it USES {other.name} ({header})")
        elif not SYSTEM.fullmatch(header):
            prefix = max((p for p in OWNERS if header.startswith(p)), key=len, default=None)
            if prefix is None:
                yield Violation(file, line, f"<{header}> has no owner in tests/house_test.py")
            elif not file.startswith(tuple(f"{owner}/" for owner in OWNERS[prefix].split())):
                yield Violation(file, line, f"<{header}> belongs to {OWNERS[prefix]} alone")


def purity_violations(file: str, code: str) -> Iterator[Violation]:
    """Input, output, threads and clocks in core."""
    for line, header, is_own in includes(code):
        is_posix = re.fullmatch(r"(sys/)?(?!immintrin)\w+\.h", header)
        if not is_own and (header in IMPURE_HEADERS or is_posix):
            yield Violation(file, line, f"core is pure: no <{header}>")
    for number, text in enumerate(bare(code).split("\n"), 1):
        found = IMPURE_CALLS.search(text)
        if found:
            yield Violation(file, number, f"core is pure: no {found.group().strip('(')}")


def text_violations(file: str, code: str) -> Iterator[Violation]:
    """Lines too long, files too long, words that are not wanted."""
    lines = code.split("\n")
    if len(lines) - 1 > MAX_FILE_LINES:
        yield Violation(file, len(lines) - 1, f"more than {MAX_FILE_LINES} lines")
    for number, line in enumerate(lines, 1):
        if len(line) > MAX_COLUMNS:
            yield Violation(file, number, f"{len(line)} columns, more than {MAX_COLUMNS}")
        found = FORBIDDEN.search(line)
        if found and not file.startswith("tests/house_test"):
            yield Violation(file, number, f"unwanted: {found.group()}")


def opening_violations(file: str, code: str) -> Iterator[Violation]:
    """Line 1 is the licence, line 2 the purpose; after a #! in scripts."""
    lines = code.split("\n")
    first = 1 if lines[0].startswith("#!") else 0
    spdx, purpose = (lines[first:] + ["", ""])[:2]
    if not re.fullmatch(r"(//|#) SPDX-License-Identifier: Apache-2\.0", spdx):
        yield Violation(file, first + 1, "no SPDX line")
    elif not re.match(r'(// |# |""")\S.{9,}', purpose):
        yield Violation(file, first + 2, "no line that says what the file is for")


def violations(root: Path) -> Iterator[Violation]:
    """All violations in the tree."""
    layers = layers_of(root)
    if not layers:
        yield Violation("CMakeLists.txt", 1, "declares no layer: nothing was checked")
    for layer in layers:
        if not (root / layer.folder / "README.md").exists():
            yield Violation(f"{layer.folder}/README.md", 1, "every layer says why it exists")
    for path in files_of(root):
        file = path.relative_to(root).as_posix()
        is_cpp = path.suffix in (".cpp", ".hpp")
        is_cmake = path.name == "CMakeLists.txt" or path.suffix == ".cmake"
        is_script = path.suffix == ".py" or path.read_bytes()[:2] == b"#!"
        if not (is_cpp or is_cmake or is_script):
            continue
        code = path.read_text()
        yield from text_violations(file, code)
        if not is_cmake:
            yield from opening_violations(file, code)
        if not is_cpp:
            continue
        for function in functions(code):
            if function.lines > MAX_FUNCTION_LINES:
                yield Violation(file, function.first_line, f"a function of {function.lines} lines, "
                                                           f"more than {MAX_FUNCTION_LINES}")
        if file.startswith("tests/"):
            continue
        yield from include_violations(file, code, layers)
        if path.suffix == ".cpp" and layer_at(layers, file) is None:
            yield Violation(file, 1, "in no layer")
        if file.startswith("core/"):
            yield from purity_violations(file, code)


def main() -> int:
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    found = list(violations(root))
    for violation in found:
        print(f"{violation.file}:{violation.line}: {violation.text}")
    print(f"{len(found)} violations")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
