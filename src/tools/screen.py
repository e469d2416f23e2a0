"""The X display that rviz draws on: the user's, or a virtual one where there is none."""
import ctypes
import ctypes.util
import os

from processes import Child


def display_reachable(name):
    """Returns whether an X server answers under this display name, for example ':0'."""
    library = ctypes.util.find_library('X11')
    if not name or not library:
        return False
    x11 = ctypes.CDLL(library)
    x11.XOpenDisplay.restype = ctypes.c_void_p
    x11.XOpenDisplay.argtypes = [ctypes.c_char_p]
    x11.XCloseDisplay.argtypes = [ctypes.c_void_p]
    display = x11.XOpenDisplay(name.encode())
    if display is None:
        return False
    x11.XCloseDisplay(display)
    return True


class Screen:
    """The user's display, or an X server without a monitor that draws in software."""

    def __init__(self, log, size=(1280, 960), folder=None):
        """folder: where a virtual one keeps its picture, in Xvfb_screen0, as xwd writes it.
        @raises RuntimeError when there is no display and Xvfb does not start."""
        self._server = None
        self.environment = {'LC_ALL': 'C'}  # rviz misreads numbers below 1 under locales with a decimal comma
        name = os.environ.get('DISPLAY')
        self.virtual = not display_reachable(name)
        if self.virtual:
            name = self._start_server(log, size, folder)
            self.environment['LIBGL_ALWAYS_SOFTWARE'] = '1'
        self.environment['DISPLAY'] = name

    def _start_server(self, log, size, folder):
        reader, writer = os.pipe()
        command = ['Xvfb', '-displayfd', str(writer), '-screen', '0', f'{size[0]}x{size[1]}x24', '+extension', 'GLX',
                   '-nolisten', 'tcp', *(['-fbdir', str(folder)] if folder else [])]
        try:
            self._server = Child(command, log, pass_fds=[writer])
        finally:
            os.close(writer)
        # Xvfb chooses a free number and writes it when it is ready; the pipe ends when it dies.
        with os.fdopen(reader) as pipe:
            number = pipe.readline().strip()
        if not number:
            raise RuntimeError(f'Xvfb did not start:\n{self._server.tail(5)}')
        return f':{number}'

    def close(self):
        if self._server:
            self._server.stop(5)
