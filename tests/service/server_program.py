"""holdfast-server as a process of its own, for the tests that are written in Python."""

import re
import subprocess
import sys
import threading

SKIPPED = 77  # what ctest takes for a test that was skipped


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


class ServerProgram:
    """Runs the server until the end of the block; .address and .admin are where it listens."""

    def __init__(self, program, *options):
        self.process = subprocess.Popen(
            [program, "--listen", "127.0.0.1:0", "--threads", "1", *options],
            stderr=subprocess.PIPE, text=True)
        self.log = []
        self.address = self._announced("event=listening")
        self.admin = self._announced("event=admin_listening") if "--admin" in options else None
        # Read on, so that the server never waits for its log.
        self.reader = threading.Thread(target=lambda: self.log.extend(self.process.stderr))
        self.reader.start()

    def _announced(self, event):
        for line in self.process.stderr:
            self.log.append(line)
            if event in line:
                return re.search(r"address=(\S+)", line).group(1)
        raise RuntimeError("the server did not start:\n" + "".join(self.log))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait(30)
        self.reader.join()
