"""The group of all commands: what is wrong with an argument is said in the project's words."""

from __future__ import annotations

from typing import Any

from pydantic import ValidationError
from typer.core import TyperGroup

from cosim.faults import words


class Commands(TyperGroup):
    """Passes errors of arguments on, with the text of the library that checked them replaced."""

    def invoke(self, ctx: Any) -> Any:
        """Carry out a command."""
        try:
            return super().invoke(ctx)
        except Exception as error:
            cause = error.__cause__
            if isinstance(cause, ValidationError) and hasattr(error, "message"):
                error.message = words(cause.errors()[0])
            raise
