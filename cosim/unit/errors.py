"""Errors that a user can act on: which file, which key, what is wrong, what to do."""

from __future__ import annotations


class InputError(Exception):
    """Something the user gave is wrong.

    Args:
        source: File, folder or command-line option at fault.
        key: Place inside it, for example `components.fabric.rows`; empty where it is the file itself.
        problem: What is wrong, with the offending value.
        remedy: What to do.
    """

    def __init__(self, source: object, key: str, problem: str, remedy: str = "") -> None:
        self.source, self.key, self.problem, self.remedy = str(source), key, problem, remedy
        where = f"{self.source}: {key}" if key else self.source
        super().__init__(f"{where}: {problem}" + (f"\n  remedy: {remedy}" if remedy else ""))

    def within(self, component: str, source: object) -> InputError:
        """The error with the scenario as its file and the key inside it; one in another file keeps that file's name."""
        key = self.key.removeprefix(f"{component}.")
        if self.source == str(source) or key != self.key:
            key = f"components.{component}.{key}" if key else f"components.{component}"
            return InputError(source, key, self.problem, self.remedy or "correct this component")
        problem = f"{self.problem} (needed by components.{component} of {source})"
        return InputError(self.source, self.key, problem, self.remedy)
