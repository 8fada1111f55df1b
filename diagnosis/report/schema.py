"""JSON Schema of diagnosis.json, made from the dataclasses; `python -m diagnosis.report.schema` writes docs/."""

from __future__ import annotations

import inspect
import json
import re
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter
from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import core_schema

from diagnosis.judge.diagnosis import Diagnosis

#: The schema as users read it; a test keeps it equal to what this file makes.
PUBLISHED = Path(__file__).parents[2] / "docs" / "diagnosis.schema.json"


class _Schema(GenerateJsonSchema):
    """Numbers may be null, keys are complete, and each has the description of its class's docstring."""

    def float_schema(self, schema: core_schema.FloatSchema) -> JsonSchemaValue:
        return {"type": ["number", "null"]}

    def dataclass_schema(self, schema: core_schema.DataclassSchema) -> JsonSchemaValue:
        made = super().dataclass_schema(schema)
        summary, arguments = _docstring(schema["cls"])
        made["description"] = summary
        made["additionalProperties"] = False
        made["required"] = list(made["properties"])  # every key is written, defaults too
        for name, about in made["properties"].items():
            about.pop("default", None)
            about.pop("title", None)
            about["description"] = arguments[name]
        return made


def schema() -> dict[str, Any]:
    """JSON Schema (draft 2020-12) of diagnosis.json."""
    made = TypeAdapter(Diagnosis).json_schema(schema_generator=_Schema, mode="serialization")
    about = made.pop("description")
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "description": f"diagnosis.json of `cosim diagnose`. {about} SI units; null stands for a number not known.",
        **made,
    }


def as_text() -> str:
    """The schema as its file has it."""
    return json.dumps(schema(), indent=2, ensure_ascii=False) + "\n"


def _docstring(cls: type) -> tuple[str, dict[str, str]]:
    """First sentence and the descriptions under `Args:` of a class."""
    text = inspect.cleandoc(cls.__doc__ or "")
    summary, _, rest = text.partition("\n")
    _, _, arguments = rest.partition("Args:\n")
    found = re.findall(r"^ {4}(\w+): (.*(?:\n {8}.*)*)", arguments, re.MULTILINE)
    return summary, {name: re.sub(r"\s+", " ", about) for name, about in found}


if __name__ == "__main__":
    PUBLISHED.write_text(as_text(), encoding="utf-8")
