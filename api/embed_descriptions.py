# SPDX-License-Identifier: Apache-2.0
# Writes both descriptions as JSON into a C++ source file:
# embed_descriptions.py OPENAPI_YAML ASYNCAPI_YAML OUTPUT_CPP
import json
import sys

import yaml

SOURCE = """// SPDX-License-Identifier: Apache-2.0
// Made from openapi.yaml and asyncapi.yaml by embed_descriptions.py.
#include "api/descriptions.hpp"

namespace kidnapwatch::api {{

std::string_view openapi_json() {{
  return R"yaml({openapi})yaml";
}}

std::string_view asyncapi_json() {{
  return R"yaml({asyncapi})yaml";
}}

}}  // namespace kidnapwatch::api
"""


def as_json(path):
    with open(path, encoding="utf-8") as document:
        return json.dumps(yaml.safe_load(document), separators=(",", ":"))


with open(sys.argv[3], "w", encoding="utf-8") as output:
    output.write(SOURCE.format(openapi=as_json(sys.argv[1]), asyncapi=as_json(sys.argv[2])))
