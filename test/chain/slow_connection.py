"""A way to an X server on which one of a program's connections is slower than its others."""

import itertools
import os
import socket
import threading
import time

CHUNK = 1 << 16  # bytes


class SlowConnection:
    """A display that hands on to another one. What a program sends on its connection `slow` (0: the first) arrives `delay` s late.
    `name`: for DISPLAY."""

    def __init__(self, display, slow, delay):
        self._target = f"/tmp/.X11-unix/X{display.lstrip(':')}"
        self._slow, self._delay = slow, delay
        number = next(n for n in range(100, 1000) if not os.path.exists(f"/tmp/.X11-unix/X{n}"))
        self._path = f"/tmp/.X11-unix/X{number}"
        self._listener = socket.socket(socket.AF_UNIX)
        self._listener.bind(self._path)
        self._listener.listen()
        self.name = f":{number}"
        threading.Thread(target=self._serve, daemon=True).start()

    def _serve(self):
        for place in itertools.count():
            try:
                client, _ = self._listener.accept()
            except OSError:  # closed
                return
            server = socket.socket(socket.AF_UNIX)
            server.connect(self._target)
            threading.Thread(target=self._hand_on, args=(client, server, self._delay if place == self._slow else 0), daemon=True).start()
            threading.Thread(target=self._hand_on, args=(server, client, 0), daemon=True).start()

    @staticmethod
    def _hand_on(source, target, delay):
        try:
            while data := source.recv(CHUNK):
                time.sleep(delay)
                target.sendall(data)
        except OSError:  # the other side has gone
            pass
        for end in (source, target):
            try:
                end.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass

    def close(self):
        self._listener.close()
        os.unlink(self._path)
