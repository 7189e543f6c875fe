#!/usr/bin/env python3
"""Nacre: do the tests notice broken code? Lines of compute/ and engine/ are picked at random, broken one at a time in a copy
of the tree, built, and judged by the test programs of their folder.

Usage: tests/mutation/run.py [--count 30] [--seed 19] [--least 27] [--only N,N...] [--list] [--scratch FOLDER] [--jobs N]
       [--cmake=-DNAME=VALUE ...]

Prints one line for each: place, what was broken, and the first test that noticed, or SURVIVED; then the score. The exit
status is 1 where fewer than --least of --count are noticed. A change that does not compile is replaced by the next one that
was drawn. --list only says what would be broken. The first run builds the copy (minutes); ccache makes the rest bearable.
"""
import argparse
import os
import random
import re
import shutil
import subprocess
import sys

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), "..", ".."))

# Folder of the broken line: test programs that are asked, in this order, until one notices. Longest prefix wins.
JUDGES = {
    "compute": ["compute", "app"],
    "engine/scene": ["scene", "app"],
    "engine/io": ["io", "app"],
    "engine/picture": ["picture", "app"],
    "engine/system": ["system", "picture", "app"],
    "engine/gl": ["gl", "render"],
    "engine/interop": ["interop"],
    "engine/render": ["render"],
}
# Of the program's own tests only those without a window: they are quick and quiet.
FILTER = {"app": "-View*:*Scripts*:*ApprovedPicture*:CtrlC*:*/CtrlC*:MeshCtrlC*:Limits*:BenchTables*"}
NOT_JUDGED = re.compile(r"^engine/io/vtk_import/|cuda")  # what no test on a CPU runs in its own process
TIME_LIMIT = 1800  # seconds for one test program: a loop that does not end is noticed, too

OPERATORS = [
    ("comparison", re.compile(r" (<=|>=|<|>) "), {"<": "<=", "<=": "<", ">": ">=", ">=": ">"}),
    ("equality", re.compile(r" (==|!=) "), {"==": "!=", "!=": "=="}),
    ("sum", re.compile(r"(?<=[\w)\]]) ([+-]) (?=[\w(])"), {"+": "-", "-": "+"}),
    ("product", re.compile(r"(?<=[\w)\]]) ([*/]) (?=[\w(])"), {"*": "/", "/": "*"}),
    ("logic", re.compile(r" (&&|\|\|) "), {"&&": "||", "||": "&&"}),
    ("accumulation", re.compile(r" (\+=|-=|\*=|/=|\|=|&=) "),
     {"+=": "-=", "-=": "+=", "*=": "/=", "/=": "*=", "|=": "&=", "&=": "|="}),
    ("truth", re.compile(r"\b(true|false)\b"), {"true": "false", "false": "true"}),
    ("constant", re.compile(r"(?<![\w.])(\d+)(?![\w.'\]>])"), None),
]
STATEMENT = re.compile(r"^\s+[a-z_][\w.>\[\]-]*(\(.*\)|(\[.*\])? [+*/|&^-]?= .*);$")
NO_CODE = re.compile(r"^\s*(//|#|template|using |namespace|class |struct |enum |static_assert|friend|public:|private:|"
                     r"protected:|case |default:|extern|inline constexpr|constexpr|const [\w:<>]+ \w+\[|$)")


def in_function(lines):
    """Numbers of lines that lie within the braces of a function: what is before them is a declaration."""
    inside, stack, result = 0, [], []
    for number, line in enumerate(lines):
        code = re.sub(r'"(\\.|[^"\\])*"', '""', line)
        code = re.sub(r"//.*", "", code)
        if inside:
            result.append(number)
        for position, c in enumerate(code):
            if c == "{":
                head = (code[:position] or "") if code[:position].strip() else ""
                context = head if head.strip() else (lines[number - 1] if number else "")
                function = inside > 0 or bool(re.search(r"\)\s*(const|noexcept|override|->.*|:.*)*\s*$", context.strip()))
                stack.append(function)
                inside += function
            elif c == "}" and stack:
                inside -= stack.pop()
    return result


def hidden(line):
    """The line with strings, characters and comments blanked out, of the same length."""
    line = re.sub(r'R"(\w*)\(.*?\)\1"', lambda m: "\0" * len(m[0]), line)
    line = re.sub(r'"(\\.|[^"\\])*"', lambda m: '"' + "\0" * (len(m[0]) - 2) + '"', line)
    line = re.sub(r"'(\\.|[^'\\])'", lambda m: "\0" * len(m[0]), line)
    return re.sub(r"//.*", lambda m: "\0" * len(m[0]), line)


def changes_of(line):
    """All (kind, new line) of a line of code."""
    code, changes = hidden(line), []
    for kind, pattern, swap in OPERATORS:
        for match in pattern.finditer(code):
            old = match[1]
            new = swap[old] if swap else str(int(old) + 1)
            changes.append((kind, line[:match.start(1)] + new + line[match.end(1):]))
    if STATEMENT.match(line) and not re.match(r"^\s+(return|throw|delete|goto|break|continue|if|for|while|else)\b", line):
        changes.append(("statement removed", re.match(r"\s*", line)[0] + ";"))
    return changes


def candidates():
    """Every line that can be broken: (path, number from 0, line)."""
    listed = subprocess.run(["git", "ls-files", "compute", "engine"], cwd=ROOT, capture_output=True, text=True, check=True)
    for path in sorted(listed.stdout.split()):
        if not path.endswith((".hpp", ".cpp")) or NOT_JUDGED.match(path):
            continue
        with open(os.path.join(ROOT, path), encoding="utf-8") as file:
            lines = file.read().split("\n")
        for number in in_function(lines):
            if not NO_CODE.match(lines[number]) and changes_of(lines[number]):
                yield path, number, lines[number]


def judges_of(path):
    folder = max((prefix for prefix in JUDGES if path.startswith(prefix + "/")), key=len)
    return JUDGES[folder]


def run(words, folder, log, limit=None):
    """Exit status; None where it took longer than the limit."""
    with open(log, "w", encoding="utf-8") as out:
        try:
            return subprocess.run(["nice", "-n", "5"] + words, cwd=folder, stdout=out, stderr=out, timeout=limit).returncode
        except subprocess.TimeoutExpired:
            return None


def prepare(scratch, options):
    """A copy of the tree as git knows it, configured, with further options for CMake."""
    tree = os.path.join(scratch, "tree")
    os.makedirs(tree, exist_ok=True)
    files = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True).stdout.split(b"\0")
    for name in filter(None, files):
        source, target = os.path.join(os.fsencode(ROOT), name), os.path.join(os.fsencode(tree), name)
        if not os.path.isfile(source):
            continue
        os.makedirs(os.path.dirname(target), exist_ok=True)
        if not os.path.exists(target) or open(source, "rb").read() != open(target, "rb").read():
            shutil.copy(source, target)
    if not os.path.exists(os.path.join(tree, "build/release/build.ninja")):
        words = ["cmake", "--preset", "release", "-DNACRE_CUDA=OFF"] + options
        if shutil.which("ccache"):
            words += ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache", "-DCMAKE_C_COMPILER_LAUNCHER=ccache"]
        if run(words, tree, os.path.join(scratch, "configure.log")) != 0:
            sys.exit("the copy could not be configured: see " + os.path.join(scratch, "configure.log"))
    return tree


def notice(tree, scratch, judges, jobs):
    """What noticed: a word; empty: nothing did; None: it does not compile."""
    build = os.path.join(tree, "build/release")
    for judge in judges:
        log = os.path.join(scratch, "build.log")
        if run(["ninja", "-C", build, "-j", str(jobs), "test_" + judge], tree, log) != 0:
            return None
        words = [os.path.join(build, "bin/test_" + judge), "--gtest_brief=1", "--gtest_filter=" + FILTER.get(judge, "*")]
        log = os.path.join(scratch, "test.log")
        status = run(words, build, log, TIME_LIMIT)
        if status is None:
            return f"test_{judge}: it did not end"
        if status != 0:
            with open(log, encoding="utf-8", errors="replace") as file:
                failed = re.findall(r"^\[  FAILED  \] ([^\s,]+)", file.read(), re.M)
            return f"test_{judge}: " + (failed[0] if failed else f"ended with status {status}")
    return ""


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--count", type=int, default=30)
    parser.add_argument("--seed", type=int, default=19)
    parser.add_argument("--least", type=int, default=27)
    parser.add_argument("--only", default="", help="numbers of the list, from 1")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--scratch", default=os.path.join(ROOT, "build/mutation"))
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--cmake", action="append", default=[], help="an option for CMake; may be given again")
    arguments = parser.parse_args()

    dice = random.Random(arguments.seed)
    drawn = [(place, dice.choice(changes_of(place[2]))) for place in dice.sample(list(candidates()), 4 * arguments.count)]
    if arguments.list:
        for number, ((path, line, old), (kind, new)) in enumerate(drawn[:arguments.count], 1):
            print(f"{number:3} {path}:{line + 1} {kind}\n    - {old.strip()}\n    + {new.strip()}")
        return
    only = {int(n) for n in arguments.only.split(",") if n}
    tree = prepare(arguments.scratch, arguments.cmake)
    tried = noticed = 0
    for number, ((path, line, old), (kind, new)) in enumerate(drawn, 1):
        if tried == arguments.count or (only and number > max(only)):
            break
        if only and number not in only:
            continue
        file = os.path.join(tree, path)
        with open(file, encoding="utf-8") as stream:
            good = stream.read()
        lines = good.split("\n")
        lines[line] = new
        with open(file, "w", encoding="utf-8") as stream:
            stream.write("\n".join(lines))
        try:
            who = notice(tree, arguments.scratch, judges_of(path), arguments.jobs)
        finally:
            with open(file, "w", encoding="utf-8") as stream:
                stream.write(good)
        verdict = "does not compile" if who is None else who or "SURVIVED"
        print(f"{number:3} {path}:{line + 1} {kind}: `{old.strip()}` -> `{new.strip()}`: {verdict}", flush=True)
        tried += who is not None
        noticed += bool(who)
    print(f"{noticed} of {tried} noticed")
    least = arguments.least if not only else 0
    sys.exit(0 if noticed >= least * tried / arguments.count and tried else 1)


if __name__ == "__main__":
    main()
