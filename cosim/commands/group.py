"""The group of all commands: what is wrong with an argument is said in the project's words."""

from __future__ import annotations

from typing import Any

from typer.core import TyperGroup


class Commands(TyperGroup):
    """Passes errors of arguments on, with the text of the library that checked them replaced."""

    def invoke(self, ctx: Any) -> Any:
        """Carry out a command."""
        try:
            return super().invoke(ctx)
        except Exception as error:
            if error.__cause__ is not None and hasattr(error, "message"):
                _reword(error, error.__cause__)
            raise


def _reword(error: Any, cause: BaseException) -> None:
    from pydantic import ValidationError  # late: a command that goes well does without

    from cosim.faults import words

    if isinstance(cause, ValidationError):
        error.message = words(cause.errors()[0])
