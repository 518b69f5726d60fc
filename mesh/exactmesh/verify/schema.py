"""The JSON Schema of reports, as it lies beside this file."""

import json
from importlib import resources

__all__ = ["report_schema"]


def report_schema() -> dict[str, object]:
    """Return the JSON Schema (draft 2020-12) of what :meth:`Report.to_json` writes.

    >>> from exactmesh.verify import report_schema
    >>> report_schema()["title"]
    'exactmesh-report/2'
    """
    schema: dict[str, object] = json.loads(
        resources.files("exactmesh.verify").joinpath("report.schema.json").read_text(encoding="utf-8")
    )
    return schema
