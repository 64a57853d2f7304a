"""How large the code is, and how it hangs together.

    python3 bench/size.py            # lines, functions, circles of imports
    python3 bench/size.py --public   # reachable public items too, by rustdoc's JSON

A line of code is one that is neither blank nor a comment, outside tests. Functions are measured
from `fn` to their closing brace, blank lines and comments left out. An import is a `use` or a path
that begins at `crate` or `super`; what a parent declares or re-exports is no circle.
"""

import json
import os
import re
import statistics
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SRC = ROOT / "src"
LONGEST = 60


def is_test(path):
    return path.name == "tests.rs" or "tests" in path.relative_to(SRC).parts[:-1]


def without_literals(text):
    """The text with comments and the insides of strings and characters blanked, lines kept."""
    pattern = re.compile(
        r'//[^\n]*|/\*.*?\*/|b?r(#*)".*?"\1|b?"(?:\\.|[^"\\])*"|b?\'(?:\\(?:u\{[^}]*\}|x..|.)|[^\'\\\n])\'', re.S
    )

    def blank(match):
        body = re.sub(r"[^\n]", " ", match[0])
        return body if match[0].startswith("/") else '""' + body[2:]

    return pattern.sub(blank, text)


def closing(text, opening):
    depth = 0
    for i in range(opening, len(text)):
        depth += (text[i] == "{") - (text[i] == "}")
        if depth == 0:
            return i
    raise ValueError("a brace is not closed")


def without_tests(text):
    """The text without items that are compiled for tests alone."""
    while match := re.search(r"#\[cfg\(test\)\]", text):
        end = min((i for i in (text.find("{", match.end()), text.find(";", match.end())) if i >= 0))
        end = closing(text, end) if text[end] == "{" else end
        text = text[: match.start()] + text[end + 1 :]
    return text


def lines_of(text):
    return sum(1 for line in text.splitlines() if line.strip())


def functions(text):
    for match in re.finditer(r"\bfn (\w+)", text):
        depth, i = 0, match.end()
        while depth or text[i] not in "{;":
            depth += (text[i] in "([") - (text[i] in ")]")
            i += 1
        if text[i] == "{":
            yield match[1], lines_of(text[match.start() : closing(text, i) + 1])


def module_of(path):
    parts = list(path.relative_to(SRC).with_suffix("").parts)
    return tuple(parts[:-1] if parts[-1] in ("mod", "lib", "main") else parts)


def imports(text, module, modules):
    """The modules that a file names, but for its parents and children."""

    def spread(prefix, body):
        body = body.strip()
        if "{" not in body:
            yield prefix + [part for part in re.split(r"::", re.sub(r"\s+as\s+\w+", "", body)) if part]
            return
        head, rest = body.split("{", 1)
        depth, item = 0, ""
        for c in rest[: rest.rindex("}")] + ",":
            if c == "," and depth == 0:
                if item.strip():
                    yield from spread(prefix + [part for part in head.split("::") if part], item)
                item = ""
            else:
                depth += (c == "{") - (c == "}")
                item += c

    paths = [p for use in re.findall(r"\buse ([^;]+);", text) for p in spread([], use)]
    bare = re.sub(r"\buse [^;]+;", "", text)
    paths += [p.split("::") for p in re.findall(r"\b(?:crate|super)(?:::\w+)+", bare)]
    for path in paths:
        at = module
        while path and path[0] in ("super", "self"):
            at, path = (at[:-1] if path[0] == "super" else at), path[1:]
        if path and path[0] == "crate":
            at, path = (), path[1:]
        elif at == module and path and at + (path[0],) not in modules:
            continue
        named = max((at + tuple(path[:k]) for k in range(len(path) + 1) if at + tuple(path[:k]) in modules), key=len)
        if named[: len(module)] != module and module[: len(named)] != named:
            yield named


def circles(graph):
    """Groups of modules that reach each other (Tarjan 1972)."""
    index, low, stack, found = {}, {}, [], []
    sys.setrecursionlimit(10_000)

    def visit(v):
        index[v] = low[v] = len(index)
        stack.append(v)
        for w in graph[v]:
            if w not in index:
                visit(w)
                low[v] = min(low[v], low[w])
            elif w in stack:
                low[v] = min(low[v], index[w])
        if low[v] == index[v]:
            group = [stack.pop()]
            while group[-1] != v:
                group.append(stack.pop())
            if len(group) > 1:
                found.append(sorted("::".join(m) for m in group))

    for v in graph:
        if v not in index:
            visit(v)
    return found


def public_items():
    """How many types, traits, functions, methods and constants can be reached from lib.rs."""
    subprocess.run(
        ["cargo", "rustdoc", "--lib", "--locked", "--", "-Zunstable-options", "--output-format", "json"],
        cwd=ROOT, check=True, env={**os.environ, "RUSTC_BOOTSTRAP": "1"},
    )
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    doc = json.loads((target / "doc/dat2glb.json").read_text())
    index, seen, counted = doc["index"], set(), set()

    def visit(key):
        item = index.get(str(key))
        if item is None or key in seen or item["crate_id"] != 0:
            return
        seen.add(key)
        (kind, inner), = item["inner"].items()
        if kind in ("struct", "enum", "union", "trait", "function", "constant", "static", "type_alias", "macro", "assoc_const"):
            counted.add(key)
        if kind == "module":
            [visit(child) for child in inner["items"]]
        elif kind == "use":
            visit(inner["id"])
        elif kind == "trait":
            [visit(child) for child in inner["items"]]
        for impl in inner.get("impls", []) if isinstance(inner, dict) else []:
            of = index[str(impl)]["inner"]["impl"]
            if of["trait"] is None:
                [visit(child) for child in of["items"] if index[str(child)]["visibility"] == "public"]

    visit(doc["root"])
    return len(counted)


def main():
    texts = {path: without_tests(without_literals(path.read_text())) for path in sorted(SRC.rglob("*.rs")) if not is_test(path)}
    total = sum(map(lines_of, texts.values()))
    every = [(lines, name, path) for path, text in texts.items() for name, lines in functions(text)]
    lengths = sorted(lines for lines, *_ in every)
    print(f"{total:,} lines of code in {len(texts)} files")
    print(f"{len(lengths):,} functions: median {statistics.median(lengths):g} lines, 90th percentile {lengths[len(lengths) * 9 // 10]}")
    for lines, name, path in sorted(every, reverse=True):
        if lines > LONGEST:
            print(f"  {lines} lines: {path.relative_to(ROOT)} {name}")
    by_folder = {}
    for path, text in texts.items():
        folder = path.relative_to(SRC).parts[0].removesuffix(".rs")
        by_folder[folder] = by_folder.get(folder, 0) + lines_of(text)
    print(", ".join(f"{folder} {lines}" for folder, lines in sorted(by_folder.items(), key=lambda entry: -entry[1])))
    modules = {module_of(path) for path in texts}
    graph = {module_of(path): set(imports(text, module_of(path), modules)) for path, text in texts.items()}
    found = circles(graph)
    print(f"{len(found)} circles of imports")
    for group in found:
        print("  " + ", ".join(group))
    if "--public" in sys.argv[1:]:
        print(f"{public_items()} reachable public items")


main()
