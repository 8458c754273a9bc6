"""The live page in a real browser: live_page_test.py SERVER HOLDFAST [SCREENSHOT].

Starts a server and a load on it, opens the page in a headless Chromium, and looks for the figures
of the session in what the browser has made of it. Skipped where there is no Chromium.
"""

import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time

from server_program import ServerProgram, skip


def browse(browser, folder, url, *options):
    """Runs the browser on one page; what it printed."""
    command = [browser, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
               "--no-proxy-server", f"--user-data-dir={folder}/profile", "--window-size=1280,900",
               "--virtual-time-budget=4000", "--timeout=60000", *options, url]
    done = subprocess.run(command, capture_output=True, text=True, timeout=150)
    assert done.returncode == 0, done.stderr
    return done.stdout


def text_of(dom):
    """What a reader sees, tags left out."""
    body = re.sub(r"<(style|script)[^>]*>.*?</\1>", " ", dom, flags=re.S)
    return re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", body))


def check(dom):
    text = text_of(dom)
    print(text)
    assert "ready" in text and "no answer" not in text, "the page has data"
    for part in ("Session 1", "Session 2", "64×48", "reliable · balanced"):
        assert part in text, part
    rates = [float(rate) for rate in re.findall(r"([\d.]+) fps", text)]
    assert len(rates) == 2 and all(1 < rate < 40 for rate in rates), rates
    for stage in ("receive", "decode", "wait", "filter", "encode", "send", "total"):
        times = re.findall(rf"\b{stage} ([\d,.]+) ([\d,.]+)", text)
        assert len(times) == 2, stage
        assert all(float(a.replace(",", "")) <= float(b.replace(",", "")) for a, b in times), times
    filtered = re.search(r"\bfilter ([\d,.]+)", text).group(1)
    assert float(filtered.replace(",", "")) > 0, "it takes time to filter"
    assert float(re.search(r"history, frames ([\d.]+)", text).group(1)) > 1
    assert re.search(r"memory [\d.]+ [KM]iB", text)
    shown = re.findall(r'<figure>.*?<img[^>]*src="/preview/\d+\.png', dom, flags=re.S)
    assert len(shown) == 2, "a figure is hidden until its picture has come"


def look_until_it_shows(look, seconds):
    """Looks again until the page shows what it must; after that time its last lack is an error.

    On a busy machine a session's first frames, and the picture that a first look makes the server
    draw, may come after the page has been read.
    """
    end = time.monotonic() + seconds
    while True:
        dom = look()
        try:
            return check(dom)
        except AssertionError as lack:
            if time.monotonic() > end:
                raise
            print(f"looks again: {lack}", file=sys.stderr)


def main():
    server, holdfast, *picture = sys.argv[1:]
    browser = shutil.which("chromium") or shutil.which("chromium-browser")
    if not browser:
        skip("package chromium is not installed")
    with tempfile.TemporaryDirectory() as folder:
        with ServerProgram(server, "--admin", "127.0.0.1:0", "--admin-previews") as running:
            load = subprocess.Popen(
                [holdfast, "load", "--server", running.address, "--sessions", "2", "--fps", "8",
                 "--seconds", "600", "--size", "64x48", "--quiet"])
            try:
                # The first look makes the server draw pictures; a later one finds them.
                url = f"http://{running.admin}/"
                look_until_it_shows(lambda: browse(browser, folder, url, "--dump-dom"), 120)
                screenshot = picture[0] if picture else os.path.join(folder, "page.png")
                browse(browser, folder, url, f"--screenshot={screenshot}")
                with open(screenshot, "rb") as file:
                    width, height = struct.unpack(">8x4x4x2I", file.read(24))
                assert (width, height) == (1280, 900), (width, height)
            finally:
                load.terminate()
                load.wait(30)
    print("the live page shows its sessions")


if __name__ == "__main__":
    main()
