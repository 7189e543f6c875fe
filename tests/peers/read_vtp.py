"""Nacre: reads the surfaces that `nacre sample` writes as .vtp: triangles, float vectors, base64."""
import base64
import re

import numpy as np

TYPES = {"Float32": np.float32, "Float64": np.float64, "UInt32": np.uint32, "Int32": np.int32}


def read(path):
    """Points (n, 3), triangles (m, 3) and the vectors `velocity` (n, 3)."""
    text = open(path, encoding="ascii").read()
    arrays = {}
    for tag, numbers in re.findall(r"<DataArray ([^>]*format=\"binary\"[^>]*)>([^<]*)<", text):
        word = dict(re.findall(r"(\w+)=\"([^\"]*)\"", tag))
        block = base64.b64decode(numbers)
        count = int.from_bytes(block[:8], "little")
        arrays[word["Name"]] = np.frombuffer(block[8:8 + count], TYPES[word["type"]])
    points, vectors = (arrays[name].reshape(-1, 3).astype(float) for name in ("Points", "velocity"))
    return points, arrays["connectivity"].reshape(-1, 3).astype(np.int64), vectors
