"""Nacre: reads the surfaces that `nacre sample` writes as .vtp: triangles, float vectors, appended base64."""
import base64
import re

import numpy as np

TYPES = {"Float32": np.float32, "Float64": np.float64, "UInt32": np.uint32, "Int32": np.int32}


def read(path):
    """Points (n, 3), triangles (m, 3) and the vectors `velocity` (n, 3)."""
    data = open(path, "rb").read()
    head, body = data.split(b'<AppendedData encoding="base64">', 1)
    body = body[body.index(b"_") + 1:]
    arrays = {}
    for tag in re.findall(r"<DataArray [^>]*format=\"appended\"[^>]*>", head.decode()):
        word = dict(re.findall(r"(\w+)=\"([^\"]*)\"", tag))
        start = int(word["offset"])
        count = int.from_bytes(base64.b64decode(body[start:start + 12])[:8], "little")
        block = base64.b64decode(body[start:start + (8 + count + 2) // 3 * 4])
        arrays[word["Name"]] = np.frombuffer(block[8:8 + count], TYPES[word["type"]])
    points, vectors = (arrays[name].reshape(-1, 3).astype(float) for name in ("Points", "velocity"))
    return points, arrays["connectivity"].reshape(-1, 3).astype(np.int64), vectors
