# SPDX-License-Identifier: Apache-2.0
# Writes openapi.yaml as JSON into a C++ source file: embed_openapi.py OPENAPI_YAML OUTPUT_CPP
import json
import sys

import yaml

SOURCE = """// SPDX-License-Identifier: Apache-2.0
// Made from openapi.yaml by embed_openapi.py.
#include "api/openapi.hpp"

namespace kidnapwatch::api {{

std::string_view openapi_json() {{
  return R"openapi({document})openapi";
}}

}}  // namespace kidnapwatch::api
"""

with open(sys.argv[1], encoding="utf-8") as document:
    text = json.dumps(yaml.safe_load(document), separators=(",", ":"))
with open(sys.argv[2], "w", encoding="utf-8") as output:
    output.write(SOURCE.format(document=text))
