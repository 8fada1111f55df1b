"""The network's C source: the base with the lines of all terms at their hooks."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from diagnosis.candidates.candidate import HOOK_AXES, CandidateTerm
from diagnosis.models.coil_network.kernel.layout import COIL_FIELDS, QUANTITIES, SOURCE_FIELDS, STRING_FIELDS

_FOLDER = Path(__file__).resolve().parent
_SCALARS = {"t": "s->t", "t_begin": "s->t_begin", "t_end": "s->t_end", "dt": "s->dt"}
#: What the lines of a coil hook may read: name to C expression.
READABLE: Mapping[str, str] = {
    "T": "s->felt[i]",
    "T_begin": "s->before[i]",
    "T_end": "s->temperature[i]",
    "T_ambient": "s->ambient[i]",
    "P": "s->power[i]",
    "I": "s->current[i]",
    "dTdt": "s->rate[i]",
    "energy": "s->energy[i]",
    "phase": "s->phase[i]",
    "stiffness": "s->stiffness[i]",
    "extension": "s->extension[i]",
    "extension_before": "s->extension_before[i]",
    "tension": "s->tension[i]",
    "heating": "s->heating[i]",
    "cooling": "s->cooling[i]",
    "heating_before": "s->heating_before[i]",
    "cooling_before": "s->cooling_before[i]",
    "crossing": "s->crossing[i]",
    "shift": "s->shift[i]",
    "remembered": "s->remembered[i]",
}
#: What the lines of a hook may change: name to C expression.
WRITABLE: Mapping[str, Mapping[str, str]] = {
    "resistance": {"R": "s->resistance[i]"},
    "source": {"V": "s->source_voltage[i]"},
    "string": {"R_string": "s->string_resistance[i]"},
    "supply": {
        "V": "s->supply_voltage[i]",
        "R_supply": "s->supply_resistance[i]",
        "I_limit": "s->current_limit[i]",
        "limited": "s->limited[i]",
    },
    "pairs": {},
    "contacts": {},
    "heat": {
        "heat": "s->heat[i]",
        "conductance": "s->conductance[i]",
        "capacity": "s->capacity[i]",
        "T_ambient": "s->ambient[i]",
    },
    "state": {},
    "gather": {},
    "shared": {},
    "accept": {},
    "stiffness": {"shift": "s->shift[i]", "scale": "s->scale[i]", "fraction": "s->fraction[i]", "added": "s->added[i]"},
    "play": {"remembered": "s->remembered[i]"},
    "load": {"tension": "s->tension[i]"},
    "length": {"extension": "s->extension[i]", "rest": "s->rest[i]"},
    "channel": {
        "offset": "sensor->offset",
        "lag": "sensor->lag",
        "share": "sensor->share",
        "partner": "sensor->partner",
    },
    "sensor": {"value": "sensor->value[n]"},
}
#: Hooks that act on two coils at once, once in each direction: hook to the plan's name of one pair.
TURNING: Mapping[str, str] = {"pairs": "pair", "contacts": "contact"}
#: Hooks that are called before the step is made: continuous states are taken at its middle.
_BEFORE_STEP = ("resistance", "heat")


def generate(terms: Sequence[CandidateTerm]) -> str:
    """C source of a network that holds all `terms`."""
    parts = [(_FOLDER / "exponential.h").read_text(), _numbers(terms), (_FOLDER / "plan.h").read_text()]
    parts.append("#define exp network_exp\n" + _quantities())
    parts += [_function(term, hook) for term in terms for hook in term.lines]
    parts += [_start(term) for term in terms if term.states]
    parts += [_calls(terms), (_FOLDER / "step.c").read_text(), (_FOLDER / "record.c").read_text()]
    return "\n".join(parts)


def _numbers(terms: Sequence[CandidateTerm]) -> str:
    lines = [f"enum {{ {', '.join(f'QUANTITY_{q}' for q in QUANTITIES)}, QUANTITIES }};"]
    for axis, fields in (("COIL", COIL_FIELDS), ("STRING", STRING_FIELDS), ("SOURCE", SOURCE_FIELDS)):
        numbers = ", ".join(f"FIELD_{name} = {n}" for n, name in enumerate(fields))
        lines.append(f"enum {{ {numbers}, {axis}_FIELDS = {len(fields)} }};")
    count = 0
    for term in terms:
        if term.states:
            lines.append(f"enum {{ STATE_{term.identifier} = {count} }};")
        count += len(term.states)
    lines.append(f"enum {{ STATES = {count} }};")
    return "\n".join(lines) + "\n"


def _quantities() -> str:
    arrays = ", ".join(f"s->{q.array}" for q in QUANTITIES.values())
    size = {"coil": "s->coils", "string": "s->strings", "supply": "(s->sources > 0)"}
    of_coils = ", ".join(str(int(q.axis == "coil")) for q in QUANTITIES.values())
    sizes = [f"(s->sources > 0 ? {size[q.axis]} : 0)" if q.needs_circuit else size[q.axis] for q in QUANTITIES.values()]
    cases = " ".join(f"case {n}: return {elements};" for n, elements in enumerate(sizes))
    flows = ", ".join(str(int(q.is_flow)) for q in QUANTITIES.values())
    return f"""#define QUANTITY_ARRAYS {arrays}
static const int quantity_is_flow[QUANTITIES] = {{{flows}}};
static const int quantity_is_of_coils[QUANTITIES] = {{{of_coils}}};
static int64_t quantity_elements(const Step *s, int q)
{{
    switch (q) {{ {cases} }}
    return 0;
}}
static int64_t quantity_channel(const Step *s, int quantity)
{{
    int64_t channel = 0;
    for (int q = 0; q < quantity; q++) {{ channel += quantity_elements(s, q); }}
    return channel;
}}
"""


def words(text: str) -> set[str]:
    """Identifiers in C lines."""
    return set(re.findall(r"[A-Za-z_]\w*", text))


def reads_current(term: CandidateTerm) -> bool:
    """Whether it is one of a sensor that reads the current in the coil of its channel."""
    return "I" in words(term.lines.get("sensor", ""))


def _state_offset(term: CandidateTerm, number: int) -> str:
    return f"(STATE_{term.identifier} + {number}) * s->width"


def _parameters(term: CandidateTerm, used: set[str], stride: str, index: str, suffix: str = "") -> list[str]:
    return [
        f"const double {p.name}{suffix} = p[{n} * ({stride}) + {index}];"
        for n, p in enumerate(term.parameters)
        if p.name + suffix in used
    ]


def _locals(term: CandidateTerm, hook: str, used: set[str]) -> tuple[list[str], list[str]]:
    """Declarations before the lines of a coil, string or source hook, and what is written back after them."""
    written = WRITABLE[hook]
    stride = {"coil": "s->width", "string": "s->strings", "source": "s->sources"}[HOOK_AXES[hook]]
    before = _parameters(term, used, stride, "i")
    readable = {**{f: f"COIL({f})[i]" for f in COIL_FIELDS}, **READABLE} if HOOK_AXES[hook] == "coil" else {}
    if hook == "string":
        readable = {"I": "s->string_current[i]"}
    own = {p.name for p in term.parameters}
    before += [
        f"const double {n} = {c};" for n, c in {**readable, **_SCALARS}.items() if n in used - set(written) - own
    ]
    before += [f"double {n} = {c};" for n, c in written.items() if n in used]
    return before, [f"{c} = {n};" for n, c in written.items() if n in used]


def _state_locals(term: CandidateTerm, hook: str, used: set[str]) -> tuple[list[str], list[str]]:
    before, after = [], []
    for number, state in enumerate(term.states):
        at = f"{_state_offset(term, number)} + {'0' if state.kind == 'shared' else 'i'}"
        is_stepped = (hook, state.kind) in (("state", "continuous"), ("shared", "shared"))
        if is_stepped:
            before.append(f"double {state.name}_inflow = 0.0, {state.name}_rate = 0.0;")
            name = state.name
            after += [
                f"const double {name}_slope = ({name}_inflow - {name}_rate * {name}) * "
                f"network_relaxation({name}_rate * s->dt);",
                f"s->state[{at}] = {name} + s->dt * {name}_slope;",
                f"s->state_rate[{at}] = {name}_inflow - {name}_rate * s->state[{at}];",
            ]
        elif state.name in used and state.kind == "memory":
            after.append(f"s->state[{at}] = {state.name};")
        if state.name in used or is_stepped:
            ahead = f" + s->dt_middle * s->state_rate[{at}]" if hook in _BEFORE_STEP else ""
            before.append(f"double {state.name} = s->state[{at}]{ahead};")
        if f"{state.name}_begin" in used:
            before.append(f"const double {state.name}_begin = s->state[{at}];")
    return before, after


def _function(term: CandidateTerm, hook: str) -> str:
    lines = term.lines[hook].strip().splitlines()
    used = words(term.lines[hook])
    head = f"static void {hook}_{term.identifier}("
    if hook in ("channel", "sensor"):
        return _sensor_function(term, hook, head)
    if hook in TURNING:
        return _pairs_function(term, hook, head)
    before, after = _locals(term, hook, used)
    state_before, state_after = _state_locals(term, hook, used)
    open_sums, close_sums, loop = "", "", "COIL_LOOP"
    if hook == "gather":
        open_sums = "double gathered_sum = 0.0, weight_sum = 0.0;"
        before.append("double gathered = 0.0, weight = 0.0;")
        after += ["gathered_sum += gathered;", "weight_sum += weight;"]
        close_sums = "sums[0] = gathered_sum; sums[1] = weight_sum;"
        loop = "for (int64_t i = 0; i < s->coils; i++)"
    elif hook == "shared":
        before.append("const double gathered = sums[0], weight = sums[1];")
        loop = "const int64_t i = 0;"
    elif HOOK_AXES[hook] != "coil":
        loop = f"for (int64_t i = 0; i < s->{HOOK_AXES[hook]}s; i++)"
    sums = ", double *sums" if hook in ("gather", "shared") else ""
    body = "\n        ".join([*state_before, *before, *lines, *after, *state_after])
    arguments = f"Step *s, const double *restrict p{sums}"
    return (
        f"{head}{arguments})\n{{\n    {open_sums}\n    {loop}\n    {{\n        {body}\n    }}\n    {close_sums}\n}}\n"
    )


def _pairs_function(term: CandidateTerm, hook: str, head: str) -> str:
    used = words(term.lines[hook])
    if hook == "pairs":
        declared = [c for x in "ab" for c in _parameters(term, used, "s->width", x, f"_{x}")]
    else:
        declared = _parameters(term, used, "s->plan->contacts", "n")
    body = "\n        ".join([*declared, *term.lines[hook].strip().splitlines()])
    one = TURNING[hook]
    return f"""{head}Step *s, const double *restrict p, int turn)
{{
    for (int64_t k = 0; k < s->plan->{hook}; k++) {{
        const int64_t n = turn == BACKWARDS ? s->plan->{hook} - 1 - k : k;
        const int64_t a = s->plan->{one}_a[n], b = s->plan->{one}_b[n];
        double exchange = 0.0; /* [W/K] */
        {body}
        exchange_heat(s, a, b, exchange, turn);
    }}
}}
"""


def _sensor_function(term: CandidateTerm, hook: str, head: str) -> str:
    used = words(term.lines[hook])
    before = _parameters(term, used, "channels", "sensor->channel")
    before += [f"double {n} = {c};" for n, c in WRITABLE[hook].items() if n in used]
    after = [f"{c} = {n};" for n, c in WRITABLE[hook].items() if n in used]
    loop = ""
    if hook == "sensor":
        loop = "for (int64_t n = 0; n < sensor->samples; n++)"
        before += ["const double t = sensor->time[n];"] if "t" in used else []
        before += ["const double I = sensor->current[n];"] if reads_current(term) else []
    body = "\n        ".join([*before, *term.lines[hook].strip().splitlines(), *after])
    arguments = "Sensor *sensor, const double *restrict p, int64_t channels"
    guard = "if (!sensor->current) { return; }" if reads_current(term) else ""
    return f"{head}{arguments})\n{{\n    {guard}\n    {loop}\n    {{\n        {body}\n    }}\n}}\n"


def _start(term: CandidateTerm) -> str:
    body = []
    for number, state in enumerate(term.states):
        used = words(state.start)
        before, _ = _locals(term, "state", used)
        at = f"{_state_offset(term, number)} + i"
        body.append(f"{{ {' '.join(before)} s->state[{at}] = {state.start}; s->state_rate[{at}] = 0.0; }}")
    inner = "\n        ".join(body)
    return (
        f"static void start_{term.identifier}(Step *s, const double *restrict p)\n{{\n"
        f"    for (int64_t i = 0; i < s->width; i++) {{\n        {inner}\n    }}\n}}\n"
    )


def _calls(terms: Sequence[CandidateTerm]) -> str:
    """Macros HOOK_<hook> that call every term that is switched on."""
    out = []
    for hook in HOOK_AXES:
        if hook == "gather":
            continue  # called together with `shared`
        is_sensor = HOOK_AXES[hook] == "channel"
        argument = "sensor" if is_sensor else "s, turn" if hook in TURNING else "s"
        calls = [_call(number, term, hook, is_sensor) for number, term in _in_order(terms, hook)]
        out.append(f"#define HOOK_{hook}({argument}) do {{ {' '.join(calls)} }} while (0)")
    starts = [f"if (ON({n})) start_{t.identifier}(s, VALUES({n}));" for n, t in enumerate(terms) if t.states]
    out.append(f"#define START_states(s) do {{ {' '.join(starts)} }} while (0)")
    feedback = [
        f"(plan)->term_offset[{n}] >= 0" for n, t in enumerate(terms) if "I" in words(t.lines.get("string", ""))
    ]
    out.append(f"#define HAS_CURRENT_FEEDBACK(plan) ({' || '.join(feedback) or '0'})")
    paired = [f"(plan)->term_offset[{n}] >= 0" for n, t in enumerate(terms) if TURNING.keys() & t.lines.keys()]
    out.append(f"#define HAS_PAIRS(plan) ({' || '.join(paired) or '0'})")
    sensors = [f"(plan)->term_offset[{n}] >= 0" for n, t in enumerate(terms) if t.axis == "channel"]
    out.append(f"#define HAS_SENSOR(plan) ({' || '.join(sensors) or '0'})")
    reading = [f"(plan)->term_offset[{n}] >= 0" for n, t in enumerate(terms) if reads_current(t)]
    out.append(f"#define READS_CURRENT(plan) ({' || '.join(reading) or '0'})")
    return "\n".join(out) + "\n"


def _in_order(terms: Sequence[CandidateTerm], hook: str) -> list[tuple[int, CandidateTerm]]:
    """Terms with a hook and their numbers, those last that hold on to the extension of the step before.

    Play and friction hold what all others have made of an extension; were a contraction added after them, it would be
    added to what they hold in every step anew.
    """
    own = [(number, term) for number, term in enumerate(terms) if hook in term.lines]
    return sorted(own, key=lambda one: hook == "length" and "extension_before" in words(one[1].lines[hook]))


def _call(number: int, term: CandidateTerm, hook: str, is_sensor: bool) -> str:
    if is_sensor:
        return (
            f"if (ON({number})) {hook}_{term.identifier}(sensor, sensor->set + plan->term_offset[{number}], CHANNELS);"
        )
    if hook in TURNING:
        return f"if (ON({number})) {hook}_{term.identifier}(s, VALUES({number}), turn);"
    if hook == "shared":
        return (
            f"if (ON({number})) {{ double sums[2]; gather_{term.identifier}(s, VALUES({number}), sums); "
            f"shared_{term.identifier}(s, VALUES({number}), sums); }}"
        )
    return f"if (ON({number})) {hook}_{term.identifier}(s, VALUES({number}));"
