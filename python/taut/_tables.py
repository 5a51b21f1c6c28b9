"""Conversion of traces to tables of pandas and xarray, which are imported only here."""


def to_pandas(trace):
    """Returns a pandas.DataFrame with one column per channel and time_s [s] as the index; `attrs` contains the trace's
    metadata."""
    import pandas

    frame = pandas.DataFrame({name: trace[name] for name in trace.channels},
                             index=pandas.Index(trace.time_s, name="time_s"))
    frame.attrs.update(trace.metadata)
    return frame


def to_xarray(trace):
    """Returns an xarray.Dataset. Channels kind/NAME/quantity become variables `kind_quantity` with the
    dimensions time_s and kind (cable, body, ...); all others become variables of time_s alone, with `/` replaced by
    `_`. The `attrs` of a variable contain its unit, the `attrs` of the set the trace's metadata."""
    import numpy
    import xarray

    units, parts, alone = trace.units, {}, []
    for name in trace.channels:
        split = name.split("/")
        if len(split) == 3:
            parts.setdefault((split[0], split[2]), []).append((split[1], name))
        else:
            alone.append(name)
    variables = {}
    for name in alone:
        variables[name.replace("/", "_")] = ("time_s", trace[name], {"units": units[name]})
    # Elements of a kind may have different quantities: each distinct set of names becomes a dimension.
    names_of = {}
    for (kind, quantity), members in parts.items():
        names = tuple(member for member, _ in members)
        known = names_of.setdefault(kind, [])
        if names not in known:
            known.append(names)
        dimension = kind if known.index(names) == 0 else f"{kind}_{known.index(names) + 1}"
        values = numpy.stack([trace[name] for _, name in members], axis=1)
        variables[f"{kind}_{quantity}"] = (("time_s", dimension), values, {"units": units[members[0][1]]})
    coordinates = {"time_s": ("time_s", trace.time_s, {"units": "s"})}
    for kind, known in names_of.items():
        for i, names in enumerate(known):
            coordinates[kind if i == 0 else f"{kind}_{i + 1}"] = list(names)
    return xarray.Dataset(variables, coordinates, attrs=trace.metadata)
