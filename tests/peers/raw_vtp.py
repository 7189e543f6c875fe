"""Nacre: reads the surfaces that `nacre sample` writes as .vtp: triangles, float vectors, raw appended data.

VTK's own reader as packaged beside newer versions of expat stops at raw data ("junk after document element").
"""
import re

import numpy as np

TYPES = {"Float32": np.float32, "Float64": np.float64, "UInt32": np.uint32, "Int32": np.int32}


def read(path):
    """Points (n, 3), triangles (m, 3) and the vectors `velocity` (n, 3)."""
    data = open(path, "rb").read()
    head, body = data.split(b'<AppendedData encoding="raw">', 1)
    body = body[body.index(b"_") + 1:]
    arrays = {}
    for tag in re.findall(r"<DataArray [^>]*format=\"appended\"[^>]*>", head.decode()):
        word = dict(re.findall(r"(\w+)=\"([^\"]*)\"", tag))
        start = int(word["offset"])
        count = int.from_bytes(body[start:start + 8], "little")
        arrays[word["Name"]] = np.frombuffer(body[start + 8:start + 8 + count], TYPES[word["type"]])
    points, vectors = (arrays[name].reshape(-1, 3).astype(float) for name in ("Points", "velocity"))
    return points, arrays["connectivity"].reshape(-1, 3).astype(np.int64), vectors
