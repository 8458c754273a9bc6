"""The files of the project that the house rules apply to."""

from pathlib import Path

FOLDERS = ("", "core", "proto", "server", "client", "tests", "deploy", "cmake")
SUFFIXES = (".h", ".cpp", ".cu", ".proto", ".py", ".sh", ".cmake")
NAMES = ("CMakeLists.txt",)


class SourceTree:
    """A checkout. Paths are relative to its root, with forward slashes.

    Folders named `generated` hold what programs wrote and are left out.
    """

    def __init__(self, root):
        self.root = Path(root)

    def files(self, folders=FOLDERS, suffixes=SUFFIXES, names=NAMES):
        """Files of these kinds at any depth of `folders` and, for "", directly at the top."""
        found = []
        for folder in folders:
            for path in (self.root / folder).rglob("*") if folder else self.root.iterdir():
                relative = path.relative_to(self.root)
                if "generated" in relative.parts or not path.is_file():
                    continue
                if path.suffix in suffixes or path.name in names:
                    found.append(relative.as_posix())
        return sorted(found)

    def lines(self, path):
        return (self.root / path).read_text(encoding="utf-8").splitlines()

    def exists(self, path):
        """True for a file of the tree and for one that CMake makes from `path`.in."""
        return (self.root / path).is_file() or (self.root / f"{path}.in").is_file()
