#!/usr/bin/env python3
"""Compares a folder of scene data with manifest.json, so that a wrong download is found before a test
fails in a puzzling way. Exit status 0: every file that is there is the right one."""

import hashlib
import json
import os
import pathlib
import sys


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else os.environ.get("HRT_DATA_ROOT")
    if not folder or not pathlib.Path(folder).is_dir():
        sys.exit("usage: check.py FOLDER (or set HRT_DATA_ROOT)")
    manifest = json.loads(pathlib.Path(__file__).with_name("manifest.json").read_text("utf-8"))
    files = [file for scene in manifest["scenes"] for file in scene["files"]]
    absent, different = [], []
    for file in files:
        path = pathlib.Path(folder, file["name"])
        if not path.is_file():
            absent.append(file["name"])
        elif hashlib.sha256(path.read_bytes()).hexdigest() != file["sha256"]:
            different.append(file["name"])
    for name in absent:
        print(f"absent     {name}")
    for name in different:
        print(f"different  {name}")
    right = len(files) - len(absent) - len(different)
    print(f"{right} right, {len(absent)} absent, {len(different)} different")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
