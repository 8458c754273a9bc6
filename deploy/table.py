#!/usr/bin/env python3
"""Prints the table of the README from the figures of `holdfast demo --json FILE`.

usage: deploy/table.py FILE [LAYER]

A row a recipe; RMSE and SSIM of LAYER (default light0.visibility), over the whole image and where
the effect moves. The best of each column is bold.
"""

import json
import sys

COLUMNS = [
    ("image", "rmse", min),
    ("image", "ssim", max),
    ("effect", "rmse", min),
    ("effect", "ssim", max),
]


def scene_table(name, recipes, layer):
    """Markdown lines of one scene."""
    lines = [
        f"| `{name}` | RMSE, image | SSIM, image | RMSE, moving shadow | SSIM, moving shadow |",
        "|---|---|---|---|---|",
    ]
    rows = {
        recipe: [f"{regions[region]['layers'][layer][metric]:.4f}" for region, metric, _ in COLUMNS]
        for recipe, regions in recipes.items()
    }
    best = [pick(row[i] for row in rows.values()) for i, (_, _, pick) in enumerate(COLUMNS)]
    for recipe, row in rows.items():
        cells = (f"**{text}**" if text == best[i] else text for i, text in enumerate(row))
        lines.append(f"| `{recipe}` | " + " | ".join(cells) + " |")
    return lines


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    layer = sys.argv[2] if len(sys.argv) == 3 else "light0.visibility"
    with open(sys.argv[1], encoding="utf-8") as file:
        scenes = json.load(file)["scenes"]
    tables = ["\n".join(scene_table(name, recipes, layer)) for name, recipes in scenes.items()]
    print("\n\n".join(tables))


if __name__ == "__main__":
    main()
