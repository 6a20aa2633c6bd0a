"""A stand-in for a server of rosbridge, on this machine."""

import json
import threading
from collections.abc import Callable, Sequence

from websockets.exceptions import ConnectionClosed
from websockets.sync.server import ServerConnection, serve


def publish(names: object, positions: object, topic: str = "/joint_states") -> str:
    """Return a message of a topic as rosbridge sends it."""
    state = {"header": {"frame_id": ""}, "name": names, "position": positions, "velocity": [], "effort": []}
    return json.dumps({"op": "publish", "topic": topic, "msg": state})


class Rosbridge:
    """A server that lets a function talk to each client that subscribes.

    Attributes:
        requests: What clients have sent.
        url: Its address.
    """

    def __init__(self, talk: Callable[[ServerConnection, int], object]) -> None:
        self.requests: list[dict[str, object]] = []
        self._talk = talk
        self._server = serve(self._attend, "127.0.0.1", 0)
        self.url = f"ws://127.0.0.1:{self._server.socket.getsockname()[1]}"
        self._thread = threading.Thread(target=self._server.serve_forever, daemon=True)

    def __enter__(self) -> "Rosbridge":
        self._thread.start()
        return self

    def __exit__(self, *reason: object) -> None:
        self._server.shutdown()
        self._thread.join()

    def _attend(self, connection: ServerConnection) -> None:
        try:
            self.requests.append(json.loads(connection.recv()))
            self._talk(connection, len(self.requests))
        except ConnectionClosed:
            pass


def saying(messages: Sequence[str]) -> Callable[[ServerConnection, int], None]:
    """Return what sends messages, and then waits until the client is gone."""

    def talk(connection: ServerConnection, number: int) -> None:
        del number
        for message in messages:
            connection.send(message)
        connection.recv()

    return talk
