"""SSPs written by hand, in the style of what other tools write."""

import zipfile

NAMESPACES = " ".join(
    f'xmlns:{prefix}="http://ssp-standard.org/SSP1/SystemStructure{name}"'
    for prefix, name in {
        "ssc": "Common",
        "ssd": "Description",
        "ssv": "ParameterValues",
        "ssm": "ParameterMapping",
        "ssb": "SignalDictionary",
    }.items()
)


def connector(name, kind, type_="Real", unit="", inner=""):
    unit = f' unit="{unit}"' if unit else ""
    typed = f"<ssc:{type_}{unit}/>" if type_ else ""
    return f'<ssd:Connector name="{name}" kind="{kind}">{typed}{inner}</ssd:Connector>'


def connectors(*listed):
    return f"<ssd:Connectors>{''.join(listed)}</ssd:Connectors>" if listed else ""


def component(name, fmu, *listed, bindings="", attributes=""):
    return (
        f'<ssd:Component name="{name}" source="resources/{fmu}" {attributes}>'
        f"{connectors(*listed)}{bindings}</ssd:Component>"
    )


def feedthrough(name, bindings="", u="", y="", fmu="feedthrough_fmi2.fmu"):
    """y = gain u + offset; units of its two connectors."""
    listed = connector("u", "input", unit=u), connector("y", "output", unit=y)
    return component(name, fmu, *listed, bindings=bindings)


def connection(start, end, inner="", **attributes):
    """`a.y` is a connector of an element, `y` one of the system itself."""
    ends = {}
    for side, text in (("start", start), ("end", end)):
        element, _, name = text.rpartition(".")
        ends |= {f"{side}Connector": name} | ({f"{side}Element": element} if element else {})
    written = " ".join(f'{k}="{v}"' for k, v in {**ends, **attributes}.items())
    return f"<ssd:Connection {written}>{inner}</ssd:Connection>"


def linear(factor, offset):
    return f'<ssc:LinearTransformation factor="{factor}" offset="{offset}"/>'


def system(name, *elements, interface=(), bindings="", connections=(), dictionaries="", attributes=""):
    wired = f"<ssd:Connections>{''.join(connections)}</ssd:Connections>" if connections else ""
    inside = f"<ssd:Elements>{''.join(elements)}</ssd:Elements>" if elements else ""
    interface = connectors(*interface)
    return f'<ssd:System name="{name}" {attributes}>{interface}{bindings}{inside}{wired}{dictionaries}</ssd:System>'


def parameter(name, value, type_="Real", shape=(), **attributes):
    more = " ".join(f'{k.replace("_", "-")}="{v}"' for k, v in attributes.items())
    dimensions = "".join(f'<ssc:Dimension size="{size}"/>' for size in shape)
    if isinstance(value, list):
        content = "".join(f'<ssv:Value value="{v}"/>' for v in value)
        typed = f"<ssv:{type_} {more}>{content}</ssv:{type_}>"
    else:
        typed = f'<ssv:{type_} value="{value}" {more}/>'
    return f'<ssv:Parameter name="{name}">{typed}{dimensions}</ssv:Parameter>'


def parameter_set(*parameters, version="1.0", units="", head="", name="values"):
    listed = f"<ssv:Parameters>{''.join(parameters)}</ssv:Parameters>"
    return f'<ssv:ParameterSet {head} version="{version}" name="{name}">{listed}{units}</ssv:ParameterSet>'


def inline(*parameters, mapping="", prefix="", version="1.0", units=""):
    """A binding with its values inside."""
    given = f' prefix="{prefix}"' if prefix else ""
    values = f"<ssd:ParameterValues>{parameter_set(*parameters, version=version, units=units)}</ssd:ParameterValues>"
    return f"<ssd:ParameterBinding{given}>{values}{mapping}</ssd:ParameterBinding>"


def bindings(*listed):
    return f"<ssd:ParameterBindings>{''.join(listed)}</ssd:ParameterBindings>"


def mapping(*entries, version="1.0"):
    return (
        f'<ssd:ParameterMapping><ssm:ParameterMapping version="{version}">{"".join(entries)}</ssm:ParameterMapping>'
        "</ssd:ParameterMapping>"
    )


def entry(source, target, inner="", **attributes):
    more = " ".join(f'{k}="{v}"' for k, v in attributes.items())
    return f'<ssm:MappingEntry source="{source}" target="{target}" {more}>{inner}</ssm:MappingEntry>'


def units(namespace, **definitions):
    """`units("ssd", mm={"m": 1, "factor": 0.001})`."""
    listed = ""
    for name, definition in definitions.items():
        base = " ".join(f'{k}="{v}"' for k, v in definition.items())
        listed += f'<ssc:Unit name="{name}"><ssc:BaseUnit {base}/></ssc:Unit>'
    return f"<{namespace}:Units>{listed}</{namespace}:Units>"


def description(root, version="1.0", after="", experiment='<ssd:DefaultExperiment startTime="0" stopTime="0.01"/>'):
    return (
        f'<?xml version="1.0" encoding="UTF-8"?>\n<ssd:SystemStructureDescription {NAMESPACES} version="{version}" '
        f'name="by hand">\n{root}\n{after}{experiment}</ssd:SystemStructureDescription>'
    )


class Packer:
    """Makes .ssp files in a folder.

    Args:
        folder: Where.
        models: Name and FMI version to FMU.
    """

    def __init__(self, folder, models):
        self.folder, self._models = folder, models

    def __call__(self, ssd, name="system.ssp", fmus=("feedthrough_fmi2",), **files):
        """An .ssp of a description, FMUs and `resources/` files given as `values_ssv="..."`."""
        path = self.folder / name
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("SystemStructure.ssd", ssd)
            for fmu in fmus:
                model, version = fmu.rsplit("_fmi", 1)
                archive.write(self._models(model, int(version)), f"resources/{fmu}.fmu")
            for key, content in files.items():
                archive.writestr(f"resources/{'.'.join(key.rsplit('_', 1))}", content)
        return path
