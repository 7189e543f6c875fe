# Nacre: flow runs of several processes.
"""What a run needs of a communicator of mpi4py. Nacre itself knows no MPI."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

from ._errors import Error

_TAG = 27
_MOST = 1 << 30  # bytes of one message

Parts = Sequence[tuple[int, memoryview]]


class Processes:
    """The processes of a communicator. What begins gives requests, and `done` says whether they have ended."""

    def __init__(self, comm: Any) -> None:
        try:
            from mpi4py import MPI
        except ImportError as error:
            raise Error("comm needs mpi4py", str(error), "pip install mpi4py") from error
        if not isinstance(comm, MPI.Intracomm) or comm == MPI.COMM_NULL:
            raise Error(f"comm is {comm!r}", "", "give a communicator of mpi4py, such as MPI.COMM_WORLD")
        if MPI.Query_thread() < MPI.THREAD_SERIALIZED:
            why = "runs call MPI from a thread of their own"
            raise Error("MPI was begun for one thread", why, 'leave mpi4py.rc.thread_level at "multiple"')
        self._mpi: Any = MPI
        self._comm: Any = comm
        self.rank: int = comm.rank
        self.count: int = comm.size

    def threads(self) -> int:
        """A fair share of the processors that this process may use."""
        on_this_machine = self._comm.Split_type(self._mpi.COMM_TYPE_SHARED)
        share: int = len(os.sched_getaffinity(0)) // on_this_machine.size
        on_this_machine.Free()
        return max(1, share)

    def begin_sum(self, numbers: memoryview) -> list[Any]:
        """Replace each number of 64 bits by its sum over all processes."""
        mpi = self._mpi
        return [self._comm.Iallreduce(mpi.IN_PLACE, [numbers, mpi.UINT64_T], op=mpi.SUM)]

    def begin_exchange(self, send: Parts, receive: Parts) -> list[Any]:
        """Send and receive bytes; both sides know how many."""
        byte = self._mpi.BYTE
        requests = [self._comm.Irecv([piece, byte], source=rank, tag=_TAG) for rank, piece in _pieces(receive)]
        requests += [self._comm.Isend([piece, byte], dest=rank, tag=_TAG) for rank, piece in _pieces(send)]
        return requests

    def done(self, requests: list[Any]) -> bool:
        return bool(self._mpi.Request.Testall(requests))


def _pieces(parts: Parts) -> list[tuple[int, memoryview]]:
    return [(rank, data[at : at + _MOST]) for rank, data in parts for at in range(0, len(data), _MOST)]
