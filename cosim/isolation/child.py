"""The process of an isolated unit: builds the unit and carries out requests until it is terminated.

It imports no Bullet, no ngspice and no scenario, so that it starts in about 0.15 s.
"""

from __future__ import annotations

import os
import resource
import signal
import sys
import traceback
from collections.abc import Callable
from typing import Any

import numpy as np

from cosim.isolation.fmi_calls import note_calls
from cosim.isolation.message import STATUSES, Channel, Closed, Frame, Kind, failure
from cosim.isolation.shared import Header, SharedArrays
from cosim.isolation.watch import Watch, memory_in_use
from cosim.unit.errors import InputError
from cosim.unit.protocol import Causality, Unit, UnitError


def serve(requests: int, replies: int, memory: int, parent: int, folder: str) -> None:
    """Entry point of the process.

    Args:
        requests: Descriptor of the pipe with requests.
        replies: Descriptor of the pipe for replies.
        memory: Descriptor of the shared memory.
        parent: Process of the simulation.
        folder: Removed when the simulation is gone.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the simulation, which stops between two steps
    for descriptor in (requests, replies, memory):
        os.set_inheritable(descriptor, False)
    header = Header(memory)
    watch = Watch(requests, parent, folder, header)
    watch.start()
    note_calls(header)
    channel = Channel(requests, replies)
    try:
        build = channel.receive().payload  # imports what the unit needs
        channel.send(Frame(Kind.READY, memory_in_use(), _largest_resident()))
        Server(channel, memory, watch, build).run()
    except Closed:
        watch.end()
    # Nothing of the FMU's library runs after this: no destructors, no exit handlers.
    os._exit(0)


def _largest_resident() -> int:
    """Largest resident set so far [byte]; what it was before the interpreter was started counts as well."""
    size = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return size if sys.platform == "darwin" else size * 1024


class Server:
    """Carries out requests on one unit.

    Args:
        channel: Connection to the simulation.
        memory: Descriptor of the shared memory.
        watch: Notes the memory in use after a failure.
        build: Makes the unit.
    """

    unit: Unit
    shared: SharedArrays

    def __init__(self, channel: Channel, memory: int, watch: Watch, build: Callable[[], Unit]) -> None:
        self.channel, self.memory, self.watch, self.build = channel, memory, watch, build
        self.kept: list[str] = []
        self.saved: dict[int, Any] = {}
        self.tokens = 0
        self.is_finished = False
        self.actions: dict[Kind, Callable[[Frame], Frame]] = {
            Kind.CONSTRUCT: self.construct,
            Kind.INITIALISE: self.initialise,
            Kind.EXIT_INITIALISATION: self.exit_initialisation,
            Kind.REFRESH: self.refresh,
            Kind.DO_STEP: self.do_step,
            Kind.FETCH: self.fetch,
            Kind.SAVE: self.save,
            Kind.RESTORE: self.restore,
            Kind.RELEASE: self.release,
            Kind.CHECKPOINT: self.checkpoint,
            Kind.RESUME: self.resume,
            Kind.TERMINATE: self.terminate,
        }

    def run(self) -> None:
        """Answer requests until the unit is terminated."""
        while not self.is_finished:
            request = self.channel.receive()
            try:
                reply = self.actions[request.kind](request)
            except Exception as error:
                if not isinstance(error, InputError | UnitError):
                    traceback.print_exc()  # its last lines become part of the error
                self.watch.note_memory()
                reply = Frame(Kind.FAILED, payload=failure(error))
            self.channel.send(reply)

    def construct(self, request: Frame) -> Frame:
        """Build the unit under the memory limit and describe it."""
        if sys.platform == "linux":
            resource.setrlimit(resource.RLIMIT_DATA, (request.first, request.first))
        self.unit = unit = self.build()
        self.shared = SharedArrays(self.memory, unit.variables, is_owner=True)
        self.put_inputs()
        return Frame(
            Kind.DONE,
            payload={
                "variables": dict(unit.variables),
                "coordinates": dict(unit.coordinates),
                "feedthrough": dict(unit.feedthrough),
                "initial_feedthrough": dict(unit.initial_feedthrough),
                "unrecorded": getattr(unit, "unrecorded", frozenset()),
                "can_restore": unit.can_restore,
                "can_checkpoint": unit.can_checkpoint,
            },
        )

    def put_inputs(self) -> None:
        """Show the unit's own values of its inputs."""
        for name in self.shared.inputs:
            self.shared.arrays[name][...] = self.unit.get(name)

    def take_inputs(self, request: Frame) -> Any:
        """Hand inputs that were set to the unit; returns what else the request carries."""
        texts: dict[str, Any] = {}
        rest = None
        if request.payload is not None:
            texts, rest = request.payload
        changed = self.shared.changed
        for index in changed.nonzero()[0]:
            name = self.shared.inputs[index]
            self.unit.set(name, texts[name] if name in texts else self.shared.arrays[name])
        changed[:] = 0
        return rest

    def done(self, first: int = 0, second: int = 0, rest: Any = None) -> Frame:
        """Show the outputs that the simulation has asked for."""
        texts = {}
        for name in self.kept:
            if name in self.shared.texts:
                texts[name] = self.unit.get(name)
            else:
                np.copyto(self.shared.arrays[name], self.unit.get(name))
        payload = (texts, rest) if texts or rest is not None else None
        return Frame(Kind.DONE, first, second, payload)

    def fetch(self, request: Frame) -> Frame:
        """From now on, show one more variable."""
        name = self.take_inputs(request)
        if self.unit.variables[name].causality is not Causality.INPUT or name in self.shared.texts:
            self.kept.append(name)
        return self.done()

    def initialise(self, request: Frame) -> Frame:
        """Initialise at `first`."""
        self.take_inputs(request)
        self.unit.initialise(request.first)
        self.put_inputs()  # what was not set is the FMU's own start value
        return self.done()

    def exit_initialisation(self, request: Frame) -> Frame:
        """Leave initialisation."""
        self.take_inputs(request)
        self.unit.exit_initialisation()
        return self.done()

    def refresh(self, request: Frame) -> Frame:
        """Let outputs follow inputs."""
        self.take_inputs(request)
        self.unit.refresh()
        return self.done()

    def do_step(self, request: Frame) -> Frame:
        """Step from `first` by `second`."""
        self.take_inputs(request)
        outcome = self.unit.do_step(request.first, request.second)
        return self.done(STATUSES.index(outcome.status), outcome.time, outcome.message or None)

    def save(self, request: Frame) -> Frame:
        """Save; the state stays here under a number."""
        self.take_inputs(request)
        self.tokens += 1
        self.saved[self.tokens] = self.unit.save()
        return self.done(self.tokens)

    def restore(self, request: Frame) -> Frame:
        """Restore the state number `second` of the time `first`."""
        self.shared.changed[:] = 0  # the state brings its own inputs
        self.unit.restore(self.saved[request.second], request.first)
        self.put_inputs()
        return self.done()

    def release(self, request: Frame) -> Frame:
        """Free the state number `second`."""
        self.take_inputs(request)
        self.unit.release(self.saved.pop(request.second))
        return Frame(Kind.DONE)

    def checkpoint(self, request: Frame) -> Frame:
        """The arrays of a checkpoint."""
        self.take_inputs(request)
        return self.done(rest=dict(self.unit.checkpoint()))

    def resume(self, request: Frame) -> Frame:
        """Continue from a checkpoint made at `first`."""
        state = self.take_inputs(request)
        self.unit.resume(state, request.first)
        self.put_inputs()
        return self.done()

    def terminate(self, request: Frame) -> Frame:
        """Free the unit; the last request."""
        self.is_finished = True
        self.unit.terminate()
        return Frame(Kind.DONE)
