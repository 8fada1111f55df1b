"""`python -m diagnosis.laws.document > docs/law-library.md`: every law with formula, numbers and source."""

from __future__ import annotations

from collections.abc import Iterator

from diagnosis.laws.law import Law, Role
from diagnosis.laws.library import library

_HEAD = """\
# The library of laws for systems of FMUs

Written by `python -m diagnosis.laws.document` from the files in `diagnosis/laws/`;
[laws.md](laws.md) says where they are tried. `rate` is what the law is added to; bounds are multiples of the
characteristic size of the product named.
"""

#: What a share is one of: a derivative, or a parameter.
_SHARE_OF = (" of the derivative as it is", " of the parameter")


def lines() -> Iterator[str]:
    """The page."""
    yield _HEAD
    for role in Role:
        yield f"## {role.value[0].upper()}{role.value[1:]}\n"
        yield "| law | what is added | numbers | source |"
        yield "|---|---|---|---|"
        for law in library():
            if law.role is role:
                yield _row(law)
        yield ""


def _row(law: Law) -> str:
    name = f"**{law.name}** `{law.identifier}`" if law.is_named else f"`{law.identifier}` (no name)"
    formula = f"`{law.formula}`{_SHARE_OF[law.role is Role.PARAMETER] if law.is_share else ''}" + "".join(
        f"; `d{s.name}/dt = {s.rate}`, from `{s.start}`" for s in law.states
    )
    formula += "".join(f"; `{d.name}(t) = {d.of}(t - {d.by})`" for d in law.delays)
    formula += f"; to the other part `{law.reaction}`" if law.reaction else ""
    numbers = "; ".join(
        f"`{n.name}` [{n.of}]: {n.meaning}, {-n.most if n.least is None else n.least:g} to {n.most:g}"
        for n in law.numbers
    )
    constants = "".join(f"; `{n}` = {share:g} of {of}" for n, (of, share) in law.constants.items())
    return f"| {name} | {formula} | {numbers}{constants} | {law.source} |"


if __name__ == "__main__":
    print("\n".join(lines()).rstrip())
