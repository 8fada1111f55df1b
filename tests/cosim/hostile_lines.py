"""Command lines that nobody means, and the files that they name."""

from __future__ import annotations

import os
import random
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SWEEP = (ROOT / "docs" / "examples" / "sweeps" / "voltage_and_convection.yaml").read_text()
DESIGN = (ROOT / "docs" / "examples" / "design" / "small.yaml").read_text()
COIL = (ROOT / "docs" / "examples" / "sweeps" / "one_coil.yaml").read_text()
RIG = """
title: t
plane: {scale: 0.25 mm, origin: [212.5, 300.0], y: right, z: up}
markers: {colour: green, diameter: 6 mm, layout: {kind: fabric, rows: 6}}
clock: {rate: 60 Hz, exposure: 8 ms}
"""
AS = "title: t\nmarkers: [base, tip]\nunit: mm\nclock: {rate: 30 Hz}\n"
KINDS = ("yaml", "csv", "fmu", "ssp", "mp4", "nc", "txt")


def lay(folder: Path) -> None:
    """Make all files, in a folder with blanks and umlauts in its name."""
    noise = random.Random(1)
    for kind in KINDS:
        (folder / f"empty.{kind}").touch()
        (folder / f"binary.{kind}").write_bytes(bytes(noise.randrange(256) for _ in range(4096)))
        (folder / f"folder.{kind}").mkdir()
        (folder / f"list.{kind}").write_text("- 1\n- 2\n")
        (folder / f"text.{kind}").write_text("This is no such file.\n")
    texts = {
        "sweep.yaml": SWEEP,
        "one_coil.yaml": COIL,
        "design.yaml": DESIGN,
        "rig.yaml": RIG,
        "as.yaml": AS,
        "twice.yaml": "title: a\ntitle: b\n",
        "sweep_nan.yaml": SWEEP.replace("from: 0.6 V", "from: .nan V"),
        "sweep_inf.yaml": SWEEP.replace("to: 1.2 V", "to: .inf V"),
        "sweep_negative.yaml": SWEEP.replace("count: 7", "count: -7"),
        "sweep_huge.yaml": SWEEP.replace("count: 7", "count: 1000000000000"),
        "sweep_many.yaml": SWEEP.replace("count: 7", "count: 100000000"),
        "sweep_key.yaml": SWEEP.replace("key: supply", "key: suply"),
        "sweep_nowhere.yaml": SWEEP.replace("one_coil.yaml", "nowhere.yaml"),
        "sweep_quantity.yaml": SWEEP.replace("quantity: actuator.temperature", "quantity: actuator.colour"),
        "design_nowhere.yaml": DESIGN + "\nscenario: nowhere.yaml\n",
        "design_wrong.yaml": DESIGN + "\ncolour: 3\n",
        "rig_nan.yaml": RIG.replace("rate: 60 Hz", "rate: .nan Hz"),
        "rig_zero.yaml": RIG.replace("rate: 60 Hz", "rate: 0 Hz"),
        "rig_negative.yaml": RIG.replace("rows: 6", "rows: -6"),
        "rig_huge.yaml": RIG.replace("rows: 6", "rows: 1000000000"),
        "as_twice.yaml": AS.replace("[base, tip]", "[base, base]"),
        "as_nan.yaml": AS.replace("30 Hz", ".nan Hz"),
        "as_one.yaml": AS.replace("[base, tip]", "base"),
        "tracks.csv": "frame,base_x,base_y,tip_x,tip_y\n" + "".join(f"{n},0,0,{n},1\n" for n in range(20)),
        "tracks_text.csv": "frame,base_x,base_y,tip_x,tip_y\n" + "".join(f"{n},0,zero,{n},1\n" for n in range(20)),
        "sensor_nan.yaml": "default: {rate: .nan Hz}\n",
        "sensor_zero.yaml": "default: {rate: 0 Hz}\n",
        "sensor_negative.yaml": "default: {rate: -5 Hz}\n",
        "sensor_huge.yaml": "default: {rate: 1e15 Hz}\n",
        "sensor_losses.yaml": "channels: {coil.temperature: {drop_outs: 1.5}}\n",
        "sensor_noise.yaml": "channels: {coil.temperature: {noise: .inf K}}\n",
        "camera_huge.yaml": "width: 100000000\nheight: 100000000\n",
        "results.json": "[]",
        "deep.yaml": "[" * 100_000,
        "number.yaml": "3\n",
        "text.yaml": "just text\n",
        "control.yaml": "title: a\0b\n",
        "rig_text.yaml": RIG.replace("rows: 6", "rows: six"),
        "rig_inf.yaml": RIG.replace("rate: 60 Hz", "rate: .inf Hz"),
        "rig_unit.yaml": RIG.replace("rate: 60 Hz", "rate: 60 kg"),
        "rig_more.yaml": RIG + "\ncolour: red\n",
        "one_line.csv": "frame,base_x\n",
        "same_name.csv": "frame,base_x,base_x\n0,1,2\n1,2,3\n",
    }
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    with zipfile.ZipFile(folder / "no_description.fmu", "w") as archive:
        archive.writestr("readme.txt", "nothing")
    with zipfile.ZipFile(folder / "bad_description.fmu", "w") as archive:
        archive.writestr("modelDescription.xml", "<fmiModelDescription")
    with zipfile.ZipFile(folder / "no_structure.ssp", "w") as archive:
        archive.writestr("readme.txt", "nothing")
    with zipfile.ZipFile(folder / "bad_structure.ssp", "w") as archive:
        archive.writestr("SystemStructure.ssd", "<ssd")
    run = folder / "not a run"
    run.mkdir()
    (run / "scenario.yaml").write_text(COIL)
    broken = folder / "broken run"
    broken.mkdir()
    (broken / "scenario.yaml").write_text(COIL)
    (broken / "results.nc").write_bytes(b"CDF no")
    (broken / "summary.json").write_text("{")
    for name in ("taken", "taken recording", "begun sweep"):
        (folder / name).mkdir()
    (folder / "loop.yaml").symlink_to(folder / "loop.yaml")
    os.mkfifo(folder / "pipe.yaml")  # a read of it would wait for ever
    (folder / "taken recording" / "recording.yaml").write_text("title: mine\n")
    (folder / "taken" / "mine.txt").write_text("mine")
    (folder / "begun sweep" / "sweep.yaml").write_text("title: mine\n")


#: Command lines that are refused: `@x` is the file x, `@out` a folder that does not exist, `@no` one that cannot be
#: made.
REFUSED = """
track @rig.yaml --rig @rig.yaml --out @out
track @text.txt --rig @rig_text.yaml --out @out
track @text.txt --rig @rig_inf.yaml --out @out
track @text.txt --rig @rig_unit.yaml --out @out
track @text.txt --rig @rig_more.yaml --out @out
track @text.txt --rig @deep.yaml --out @out
track @text.txt --rig @control.yaml --out @out
track @text.txt --rig @number.yaml --out @out
track @loop.yaml --rig @loop.yaml --out @out
track @pipe.yaml --rig @rig.yaml --out @out
track @taken --rig @rig.yaml --out @out
play @taken --mp4 @out.gif
play single_coil_heating
play '@broken run' --gif @no.gif
play @control.yaml
play @pipe.yaml
play @loop.yaml
play @taken --width nan
play @taken --width -5
play https://example.org/run
sweep @control.yaml --out @out
sweep @deep.yaml --out @out
sweep @number.yaml --out @out
sweep @text.yaml --out @out
sweep @pipe.yaml --out @out
sweep @loop.yaml --out @out
sweep '' --out @out
sweep @sweep.yaml --cluster nowhere --out @out
design @control.yaml --out @out
design @deep.yaml --out @out
design @number.yaml --out @out
design @text.yaml --out @out
design @pipe.yaml --out @out
design @loop.yaml --out @out
design '' --out @out
recording new @one_line.csv --scenario tclab --out @out
recording new @same_name.csv --scenario tclab --out @out
recording new @pipe.yaml --scenario tclab --out @out
recording new /dev/zero --scenario tclab --out @out
recording new /dev/full --scenario tclab --out @out
recording import /dev/zero --as @as.yaml --out @out
recording import @tracks.csv --as /dev/zero --out @out
track @text.txt --rig /dev/zero --out @out
track /dev/zero --rig @rig.yaml --out @out
play /dev/zero
sweep /dev/zero --out @out
design /dev/zero --out @out
record /dev/zero --out @out
compare /dev/zero --out @out
fmu info /dev/zero
ssp import /dev/zero --out @out
ssp validate /dev/zero
recording new @loop.yaml --scenario tclab --out @out
recording new '' --scenario tclab --out @out
recording new @tracks.csv --scenario '' --out @out
recording new @tracks.csv --scenario @deep.yaml --out @out
recording check '' --scenario tclab
recording check @taken --scenario tclab
recording check '@taken recording' --scenario tclab
recording check @loop.yaml --scenario tclab
recording import @one_line.csv --as @as.yaml --out @out
recording import @same_name.csv --as @as.yaml --out @out
recording import @pipe.yaml --as @as.yaml --out @out
recording import @tracks.csv --as @deep.yaml --out @out
recording import @tracks.csv --as @control.yaml --out @out
recording import @tracks.csv --as @number.yaml --out @out
recording import '' --as @as.yaml --out @out
ssp import '' --out @out
ssp import @loop.yaml --out @out
ssp import @pipe.yaml --out @out
ssp import @deep.yaml --out @out
ssp import @no_structure.ssp --step nan --out @out
ssp import @no_structure.ssp --step 0 --out @out
ssp validate ''
ssp validate @loop.yaml
ssp validate @pipe.yaml
ssp export '' --out @out.ssp
ssp export @deep.yaml --out @out.ssp
ssp export @number.yaml --out @out.ssp
fmu info ''
fmu info @loop.yaml
fmu info @pipe.yaml
fmu info @deep.yaml
fmu validate ''
fmu validate @loop.yaml
fmu validate @pipe.yaml
fmu build ''
fmu build thermal_stiffness --coils 1e3
fmu build thermal_stiffness --coils 0
fmu export '' --out @out
fmu new .
fmu new ..
fmu new 🧵
fmu info @missing.fmu
fmu info @folder.fmu
fmu info @empty.fmu
fmu info @binary.fmu
fmu info @text.txt
fmu info @no_description.fmu
fmu info @bad_description.fmu
fmu info @list.yaml
fmu validate @missing.fmu
fmu validate @folder.fmu
fmu validate @empty.fmu
fmu validate @binary.fmu
fmu build @missing
fmu build @folder.fmu
fmu build @empty.fmu
fmu build thermal_stifness
fmu build thermal_stiffness --coils -1
fmu build thermal_stiffness --coils 99999999999
fmu build thermal_stiffness --fmi 4
fmu build thermal_stiffness --coils nan
fmu build thermal_stiffness --out @no
fmu export thermal_stifness --out @out
fmu export thermal_stiffness --coils 0
fmu export thermal_stiffness --out @no
fmu new @taken
fmu new 1abc
fmu new ''
fmu new @no
fmu new 'Prüf stand'
ssp import @missing.ssp --out @out
ssp import @folder.ssp --out @out
ssp import @empty.ssp --out @out
ssp import @binary.ssp --out @out
ssp import @text.txt --out @out
ssp import @no_structure.ssp --out @out
ssp import @bad_structure.ssp --out @out
ssp import @no_structure.ssp --out @taken
ssp import @no_structure.ssp --out @empty.txt
ssp validate @missing.ssp
ssp validate @folder.ssp
ssp validate @empty.ssp
ssp validate @binary.ssp
ssp validate @bad_structure.ssp
ssp validate @list.yaml
ssp validate @no_structure.ssp --schema @missing
ssp export @missing.yaml --out @out.ssp
ssp export single_coil_heating --out @out.txt
ssp export single_coil_heating --out @no.ssp
ssp export single_coil_heating --out @folder.ssp
ssp export @list.yaml --out @out.ssp
ssp export single_coil_heating --version 3 --out @out.ssp
track @missing.mp4 --rig @rig.yaml --out @out
track @empty.mp4 --rig @rig.yaml --out @out
track @binary.mp4 --rig @rig.yaml --out @out
track @folder.mp4 --rig @rig.yaml --out @out
track @binary.mp4 --rig @missing.yaml --out @out
track @binary.mp4 --rig @empty.yaml --out @out
track @binary.mp4 --rig @list.yaml --out @out
track @binary.mp4 --rig @twice.yaml --out @out
track @binary.mp4 --rig @binary.yaml --out @out
track @binary.mp4 --rig @rig_nan.yaml --out @out
track @binary.mp4 --rig @rig_zero.yaml --out @out
track @binary.mp4 --rig @rig_negative.yaml --out @out
track @binary.mp4 --rig @rig_huge.yaml --out @out
track @binary.mp4 --rig @folder.yaml --out @out
track @binary.mp4 --rig '@taken recording' --out @out
track @binary.mp4 --rig @rig.yaml --out '@taken recording'
compare @missing.yaml --out @out
compare @folder.yaml --out @out
compare @empty.yaml --out @out
compare @binary.yaml --out @out
compare @list.yaml --out @out
compare @twice.yaml --out @out
compare pendulum --out @out
compare hanging_coils --actuators thermal_stifness --out @out
compare hanging_coils --actuators @missing.fmu --out @out
compare hanging_coils --actuators @binary.fmu --out @out
compare hanging_coils --fmi 4 --out @out
compare hanging_coils --component nobody --out @out
compare hanging_coils --jobs 0 --out @out
compare hanging_coils --jobs -1 --out @out
compare hanging_coils --actuators thermal_stiffness --out @no
compare hanging_coils --actuators thermal_stiffness --out @empty.txt
compare hanging_coils --actuators , --out @no
reproduce --out @no
reproduce --out @empty.txt
reproduce --starts 0
reproduce --starts -3
reproduce --bands 1
reproduce --bands -1
reproduce --starts 3 --bands 3
reproduce --jobs 0
reproduce --jobs many
example rigg
example rig --out @taken
example passive_drape --out @no
example passive_drape --out @empty.yaml
example ''
example ../passive_drape
example passive_drape --out @empty.txt/x.yaml
prove --cases 0 --out @out
prove --cases -1 --out @out
prove --kinds nonsense --out @out
prove --setups nonsense --out @out
prove --resume --out @out
prove --table @missing --out @out
prove --table @taken --page @out
prove --out @empty.txt
prove --out @no
prove --limit 0 --out @out
prove --limit nan --out @out
prove --so-far --out @out
prove --seed -1 --out @out
prove --jobs 0 --out @out
play @missing
play @empty.txt
play @taken
play '@not a run'
play '@broken run'
play @folder.nc
play @taken --out @out.txt
play @taken --speed 0
play @taken --speed nan
play @taken --speed -1
play @taken --frames 1
play @taken --width 99999
play @taken --gif @out.mp4
play @binary.nc
play @taken @taken
recording import @missing.csv --as @as.yaml --out @out
recording import @folder.csv --as @as.yaml --out @out
recording import @empty.csv --as @as.yaml --out @out
recording import @binary.csv --as @as.yaml --out @out
recording import @list.yaml --as @as.yaml --out @out
recording import @tracks_text.csv --as @as.yaml --out @out
recording import @tracks.csv --as @missing.yaml --out @out
recording import @tracks.csv --as @empty.yaml --out @out
recording import @tracks.csv --as @list.yaml --out @out
recording import @tracks.csv --as @twice.yaml --out @out
recording import @tracks.csv --as @as_twice.yaml --out @out
recording import @tracks.csv --as @as_nan.yaml --out @out
recording import @tracks.csv --as @as_one.yaml --out @out
recording import @tracks.csv --as @folder.yaml --out @out
recording import @tracks.csv --as @as.yaml --out '@taken recording'
recording new @missing.csv --scenario tclab --out @out
recording new @folder.csv --scenario tclab --out @out
recording new @binary.csv --scenario tclab --out @out
recording new @tracks.csv --scenario nobody --out @out
recording check @missing --scenario tclab
recording check @empty.csv --scenario tclab
sweep @missing.yaml --out @out
sweep @folder.yaml --out @out
sweep @empty.yaml --out @out
sweep @binary.yaml --out @out
sweep @list.yaml --out @out
sweep @twice.yaml --out @out
sweep @sweep_nan.yaml --out @out
sweep @sweep_inf.yaml --out @out
sweep @sweep_negative.yaml --out @out
sweep @sweep_huge.yaml --out @out
sweep @sweep_many.yaml --out @out
sweep @sweep_key.yaml --out @out
sweep @sweep_nowhere.yaml --out @out
sweep @sweep_quantity.yaml --out @out
sweep @sweep.yaml --out @no
sweep @sweep.yaml --out @empty.txt
sweep @sweep.yaml --out '@begun sweep'
sweep @sweep.yaml --resume --out @out
sweep @sweep.yaml --jobs 0 --out @out
sweep @one_coil.yaml --out @out
design @missing.yaml --out @out
design @folder.yaml --out @out
design @empty.yaml --out @out
design @binary.yaml --out @out
design @list.yaml --out @out
design @twice.yaml --out @out
design @design_nowhere.yaml --out @out
design @design_wrong.yaml --out @out
design @one_coil.yaml --out @out
design @design.yaml --jobs -2 --out @out
record @missing.yaml --out @out
record @folder.yaml --out @out
record @empty.yaml --out @out
record @binary.yaml --out @out
record @list.yaml --out @out
record '@not a run' --out @out
record '@broken run' --out @out
record single_coil_heating --sensor @missing.yaml --out @out
record single_coil_heating --sensor @list.yaml --out @out
record single_coil_heating --sensor @empty.yaml --out @no
record single_coil_heating --sensor @sensor_nan.yaml --out @out
record single_coil_heating --sensor @sensor_zero.yaml --out @out
record single_coil_heating --sensor @sensor_negative.yaml --out @out
record single_coil_heating --sensor @sensor_losses.yaml --out @out
record single_coil_heating --sensor @sensor_noise.yaml --out @out
record single_coil_heating --sensor @sensor_huge.yaml --out @out
record single_coil_heating --out '@taken recording'
record single_coil_heating --seed -1 --out @out
record single_coil_heating --channels nonsense --out @out
record single_coil_heating --channels 'coil[99].temperature' --out @out
record single_coil_heating --out @no
record single_coil_heating --out @empty.txt
record passive_drape --video @missing.yaml --out @out
record passive_drape --video @list.yaml --out @out
record passive_drape --video @camera_huge.yaml --out @out
record single_coil_heating --video @missing.yaml --channels x --out @out
""".strip().splitlines()
