# SPDX-License-Identifier: Apache-2.0
# Writes files as a table of assets into a C++ source file: embed.py OUTPUT_CPP FILE...
import gzip
import hashlib
import sys
from pathlib import Path

TYPES = {
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".svg": "image/svg+xml",
    ".txt": "text/plain; charset=utf-8",
}
SOURCE = """// SPDX-License-Identifier: Apache-2.0
// Made by embed.py.
#include <array>

#include "api/assets.hpp"

namespace kidnapwatch::api {{
namespace {{

using std::string_view_literals::operator""sv;

constexpr std::array kAssets{{
{assets}
}};

}}  // namespace

std::span<const Asset> assets() {{ return kAssets; }}

}}  // namespace kidnapwatch::api
"""


def literal(data: bytes) -> str:
    """A C++ string literal; octal escapes have three digits, so that none runs on."""
    plain = {byte: chr(byte) for byte in range(0x20, 0x7F)}
    plain |= {ord(char): "\\" + char for char in '"\\?'}
    return '"' + "".join(plain.get(byte, f"\\{byte:03o}") for byte in data) + '"sv'


def asset(path: Path) -> str:
    data = path.read_bytes()
    digest = hashlib.sha256(data).hexdigest()[:16]
    packed = gzip.compress(data, compresslevel=9, mtime=0)
    fields = (path.name.encode(), TYPES[path.suffix].encode(), digest.encode(), data, packed)
    return "    Asset{" + ", ".join(map(literal, fields)) + "},"


Path(sys.argv[1]).write_text(SOURCE.format(assets="\n".join(asset(Path(p)) for p in sys.argv[2:])))
