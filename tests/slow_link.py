"""A slow way to a server: bytes of all connections share a rate, and each takes its time."""

import asyncio
import contextlib
import threading
from types import TracebackType

_PIECE = 1460
"""Bytes that travel together: those of a packet of TCP."""


class _Lane:
    """One direction of the way."""

    def __init__(self, rate: float, delay: float) -> None:
        self._rate, self._delay, self._free_at = rate, delay, 0.0
        self.bytes = 0

    def arrival(self, length: int, now: float) -> float:
        """Return when so many bytes arrive that set out now, behind those of before."""
        self.bytes += length
        self._free_at = max(self._free_at, now) + length / self._rate
        return self._free_at + self._delay


class SlowLink:
    """Stands in front of a port of this machine, as long as a ``with`` statement lasts.

    Attributes:
        port: The slow way's own port.
        connections: How many were made.
    """

    def __init__(self, port: int, *, rate: float = 1.25e6, delay: float = 0.05) -> None:
        """Describe the way.

        Args:
            port: Of the server.
            rate: Bytes a second, of either direction.
            delay: How long bytes take in either direction [s]. A new connection takes three times as long, since a
                packet goes there and back before the first one with bytes sets out.
        """
        self.port = self.connections = 0
        self._server_port, self._delay = port, delay
        self._up, self._down = _Lane(rate, delay), _Lane(rate, delay)
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="slow link", daemon=True)

    @property
    def received(self) -> int:
        """How many bytes have come from the server."""
        return self._down.bytes

    def __enter__(self) -> "SlowLink":
        """Listen."""
        self._thread.start()
        listening = asyncio.start_server(self._serve, "127.0.0.1", 0)
        self._server = asyncio.run_coroutine_threadsafe(listening, self._loop).result()
        self.port = int(self._server.sockets[0].getsockname()[1])
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End all connections."""
        asyncio.run_coroutine_threadsafe(self._end(), self._loop).result()
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    async def _end(self) -> None:
        self._server.close()
        others = asyncio.all_tasks() - {asyncio.current_task()}
        for task in others:
            task.cancel()
        await asyncio.gather(*others, return_exceptions=True)
        await asyncio.sleep(0)  # closed connections end with the next turn of the loop

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.connections += 1
        opened = self._loop.time() + 2 * self._delay
        there, back = await asyncio.open_connection("127.0.0.1", self._server_port)
        up, down = self._carry(reader, back, self._up, opened), self._carry(there, writer, self._down, opened)
        try:
            with contextlib.suppress(ConnectionError):
                await asyncio.gather(up, down)
        finally:
            writer.close()
            back.close()

    async def _carry(
        self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, lane: _Lane, opened: float
    ) -> None:
        under_way = asyncio.Queue[tuple[float, bytes]]()

        async def deliver() -> None:
            data = b"begin"
            while data:
                arrival, data = await under_way.get()
                await asyncio.sleep(arrival - self._loop.time())
                writer.write(data)
                await writer.drain()
            writer.close()

        async def take() -> None:
            data = b"begin"
            while data:
                data = await reader.read(_PIECE)
                under_way.put_nowait((lane.arrival(len(data), max(self._loop.time(), opened)), data))

        await asyncio.gather(deliver(), take())
