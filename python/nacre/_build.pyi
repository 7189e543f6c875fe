#: Level of the instruction set that `_core` is compiled for: x86-64-v2, native, ...
march: str
#: Further levels that there is a `_core` of, in levels/NAME.
levels: tuple[str, ...]
