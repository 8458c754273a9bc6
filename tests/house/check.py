"""Checks the house rules over a checkout: check.py ROOT {includes,length,markers}."""

import argparse
import sys

import include_rules
import text_rules
from source_tree import SourceTree

RULES = {
    "includes": include_rules.check,
    "length": text_rules.check_length,
    "markers": text_rules.check_markers,
}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("root")
    parser.add_argument("rule", choices=RULES)
    arguments = parser.parse_args()

    tree = SourceTree(arguments.root)
    files = tree.files()
    if not files:
        sys.exit(f"{arguments.root}: no source files found")
    violations = RULES[arguments.rule](tree)
    for path, line, message in violations:
        print(f"{path}:{line}: {message}")
    print(f"{arguments.rule}: {len(files)} files, {len(violations)} violations")
    sys.exit(1 if violations else 0)


if __name__ == "__main__":
    main()
