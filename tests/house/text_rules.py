"""Rules on the text of files: how long they are, and that none is left unfinished."""

import re
from pathlib import Path

MAX_LINES = 400
MARKERS = Path(__file__).with_name("markers.txt")


def check_length(tree):
    """Violations of MAX_LINES as (path, line number, message)."""
    violations = []
    for path in tree.files():
        count = len(tree.lines(path))
        if count > MAX_LINES:
            violations.append((path, count, f"has {count} lines, the limit is {MAX_LINES}"))
    return violations


def markers():
    """The markers of unfinished work; upper-case ones match as written, others in any case."""
    lines = MARKERS.read_text(encoding="utf-8").splitlines()
    return [line for line in lines if line and not line.startswith("#")]


def check_markers(tree):
    """Violations as (path, line number, message)."""
    patterns = [
        (word, re.compile(rf"\b{re.escape(word)}\b", 0 if word.isupper() else re.IGNORECASE))
        for word in markers()
    ]
    violations = []
    for path in tree.files():
        for number, line in enumerate(tree.lines(path), 1):
            for word, pattern in patterns:
                if pattern.search(line):
                    violations.append((path, number, f'"{word}" marks unfinished work'))
    return violations
