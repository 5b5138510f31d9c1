"""The lobelia command as a child process: progress, cancelling, its messages."""
import re
import signal
import subprocess
import threading


class Command:
    """A running command. Poll it: `progress` in [0, 1] or None, `messages` of its standard error."""

    def __init__(self, arguments):
        self.messages, self.progress = [], None
        try:
            self.process = subprocess.Popen(arguments, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, bufsize=0)
        except OSError as error:
            raise RuntimeError(f"{arguments[0]}: {error.strerror}; set the program in the add-on's preferences") from error
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()

    def _read(self):
        # Progress bars end in a carriage return, messages in a new line.
        text = b""
        for byte in iter(lambda: self.process.stderr.read(256), b""):
            text += byte
            *lines, text = re.split(rb"[\r\n]+", text)
            for line in lines:
                self._take(line.decode(errors="replace").strip())
        self._take(text.decode(errors="replace").strip())

    def _take(self, line):
        share = re.search(r"(\d+(?:\.\d+)?) ?%", line)
        if line.startswith("lobelia:"):
            self.messages.append(line)
        elif share:
            self.progress = float(share.group(1)) / 100

    def poll(self):
        """The exit status, or None while it runs."""
        status = self.process.poll()
        if status is not None:
            self.reader.join()
        return status

    def cancel(self):
        """Asks it to stop, as Ctrl-C does, and waits: it leaves nothing half written."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        self.process.wait()
        self.reader.join()

    def error(self):
        """The last message, for a report."""
        errors = [m for m in self.messages if "warning" not in m]
        return (errors or self.messages or ["lobelia: no message"])[-1]
