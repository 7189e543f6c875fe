#!/usr/bin/env python3
"""Nacre: do the tests notice broken code? Lines of compute/ and engine/ are picked at random and broken, one at a time, in a
copy of the tree; the test programs of their folder judge each.

Usage: tests/mutation/run.py [--count 30] [--seed 19] [--least 27] [--only N,N...] [--list] [--scratch FOLDER] [--jobs N]
       [--cmake=-DNAME=VALUE ...]

Prints one line for each: position, what was broken, and the first test that noticed, or SURVIVED; then the score. The exit
status is 1 where fewer than --least of --count are noticed. A change that does not compile is replaced by the next one that
was drawn. --list only says what would be broken.

All changes are compiled at once, each behind a switch that the environment variable NACRE_MUTANT turns (0: none), so that
one build serves for all. A change that cannot be switched so, as in a constant, is built alone.
"""
import argparse
import collections
import hashlib
import os
import re
import shutil
import subprocess
import sys

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), "..", ".."))

# Folder of the broken line: test programs that are asked, in this order, until one notices. Longest prefix wins.
JUDGES = {
    "compute": ["compute", "app"],
    "engine/run": ["app"],
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
NOT_JUDGED = re.compile(r"^engine/(io/vtk_import|parallel)/|cuda")  # what no test on a CPU runs in its own process
TIME_LIMIT = 900  # seconds for one test program: a loop that does not end is noticed, too

# Changes that cannot make a difference: (path, line, changed line), and why. They are not drawn.
EQUIVALENT = {
    ("compute/raycast/render.hpp",
     "float brightness = shading.ambient + (1 - shading.ambient) * (diffuse > 0 ? diffuse : 0);",
     "float brightness = shading.ambient + (1 - shading.ambient) * (diffuse >= 0 ? diffuse : 0);"):
        "at 0 both branches are 0",
    ("compute/meshing/vertex_fans.hpp",
     "std::sort(counts_.begin(), counts_.end(), [](const auto& s, const auto& t) { return s.material < t.material; });",
     "std::sort(counts_.begin(), counts_.end(), [](const auto& s, const auto& t) { return s.material <= t.material; });"):
        "each material is there once",
    ("compute/meshing/surface_nets.cpp", "layers[n] = {};", ";"): "frees memory early; results are the same",
}

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


def draw(seed):
    """All candidates with a change each, in an order of chance: ((path, number, line), (kind, new line)).

    The order is by a hash of the line itself, so that the same lines are drawn after an edit elsewhere."""
    def lot(*parts):
        return hashlib.sha256("\0".join([str(seed), *parts]).encode()).digest()

    drawn, seen = [], collections.Counter()
    for path, number, line in candidates():
        seen[path, line] += 1
        hashed = lot(path, line, str(seen[path, line]))
        changes = changes_of(line)
        change = changes[int.from_bytes(hashed[:8], "big") % len(changes)]
        if (path, line.strip(), change[1].strip()) not in EQUIVALENT:
            drawn.append((hashed, (path, number, line), change))
    return [entry[1:] for entry in sorted(drawn)]


def judges_of(path):
    folder = max((prefix for prefix in JUDGES if path.startswith(prefix + "/")), key=len)
    return JUDGES[folder]


def run(command, folder, log, limit=None):
    """Exit status; None where it took longer than the limit."""
    with open(log, "w", encoding="utf-8") as out:
        try:
            return subprocess.run(["nice", "-n", "5"] + command, cwd=folder, stdout=out, stderr=out, timeout=limit).returncode
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
        command = ["cmake", "--preset", "release", "-DNACRE_CUDA=OFF"] + options
        if shutil.which("ccache"):
            command += ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache", "-DCMAKE_C_COMPILER_LAUNCHER=ccache"]
        if run(command, tree, os.path.join(scratch, "configure.log")) != 0:
            sys.exit("the copy could not be configured: see " + os.path.join(scratch, "configure.log"))
    return tree


SWITCH = """#pragma once
#include <cstdlib>
#include <type_traits>
inline const int nacre_chosen_mutant = std::getenv("NACRE_MUTANT") ? std::atoi(std::getenv("NACRE_MUTANT")) : 0;
constexpr bool nacre_mutant(int number) { return !std::is_constant_evaluated() && nacre_chosen_mutant == number; }
"""


def outward(code, at, step, ends):
    """From a position of a line of code on, to the first of the `ends`, or bracket, that is not within brackets."""
    inner, outer = (")]}", "([{") if step < 0 else ("([{", ")]}")
    depth = 0
    while at > 0 if step < 0 else at < len(code):
        c = code[at - 1] if step < 0 else code[at]
        if depth == 0 and (at in ends or c in outer):
            break
        depth += (c in inner) - (c in outer)
        at += step
    return at


def expression_around(code, first, last):
    """The whole expression that [first, last) of a line of code is in: as far as a bracket, comma, semicolon, = or return."""
    begins = {match.end() for match in re.finditer(r"(?<![=!<>])=(?!=)|\breturn\b|[,;]", code)}
    ends = {match.start() for match in re.finditer("[,;]", code)}
    return outward(code, first, -1, begins), outward(code, last, 1, ends)


def switched(kind, old, new, number):
    """One line that is `new` where the mutant is chosen, else `old`; None: this line cannot be switched."""
    on, indent = f"nacre_mutant({number})", re.match(r"\s*", old)[0]
    if kind == "statement removed":
        return f"{indent}{{ if (!{on}) {{ {old.strip()} }} }}"
    if kind == "accumulation":
        return f"{indent}{{ if ({on}) {{ {new.strip()} }} else {{ {old.strip()} }} }}" if old.endswith(";") else None
    first = next(i for i, (a, b) in enumerate(zip(old, new)) if a != b)
    after = next(i for i, (a, b) in enumerate(zip(old[::-1], new[::-1])) if a != b)
    begin, end = expression_around(hidden(old), first, len(old) - after)
    if end == len(old):  # it goes on in the next line
        return None
    is_there = old[begin:end].strip()
    becomes = new[begin:end + len(new) - len(old)].strip()
    return f"{old[:begin]} ({on} ? ({becomes}) : ({is_there})){old[end:]}"


class Copy:
    """The copy of the tree: lines are changed in it, and it is built."""

    def __init__(self, tree, scratch, jobs):
        self.tree, self.scratch, self.jobs = tree, scratch, jobs
        self.build_folder, self.good = os.path.join(tree, "build/release"), {}
        with open(os.path.join(tree, "mutant_switch.hpp"), "w", encoding="utf-8") as file:
            file.write(SWITCH)

    def write(self, path, changes):
        """The file with these lines (by number from 0) changed; none: as it was."""
        file = os.path.join(self.tree, path)
        if path not in self.good:
            with open(file, encoding="utf-8") as stream:
                self.good[path] = stream.read()
        lines = self.good[path].split("\n")
        for line, text in changes.items():
            lines[line] = text
        if any("nacre_mutant(" in text for text in changes.values()):  # in a line that has code already: numbers stay
            first = next(i for i, line in enumerate(lines) if line.startswith("#include"))
            lines[first] = '#include "mutant_switch.hpp"\n#line %d\n' % (first + 1) + lines[first]
        with open(file, "w", encoding="utf-8") as stream:
            stream.write("\n".join(lines))

    def build(self, judges):
        """The positions (path, line from 0) that errors are at; none: it was built."""
        log = os.path.join(self.scratch, "build.log")
        command = ["ninja", "-C", self.build_folder, "-k", "0", "-j", str(self.jobs)] + ["test_" + judge for judge in judges]
        if run(command, self.tree, log) == 0:
            return []
        with open(log, encoding="utf-8", errors="replace") as file:
            found = re.findall(r"((?:compute|engine)/[\w/]+\.[ch]pp):(\d+)", file.read())
        return {(path, int(line) - 1) for path, line in found} or {("", 0)}

    def notice(self, judges, number):
        """What noticed; empty: nothing did."""
        for judge in judges:
            command = ["env", f"NACRE_MUTANT={number}", os.path.join(self.build_folder, "bin/test_" + judge),
                     "--gtest_brief=1", "--gtest_fail_fast", "--gtest_filter=" + FILTER.get(judge, "*")]
            log = os.path.join(self.scratch, "test.log")
            status = run(command, self.build_folder, log, TIME_LIMIT)
            if status is None:
                return f"test_{judge}: it did not end"
            if status != 0:
                with open(log, encoding="utf-8", errors="replace") as file:
                    failed = re.findall(r"^\[  FAILED  \] ([^\s,]+)", file.read(), re.M)
                return f"test_{judge}: " + (failed[0] if failed else f"ended with status {status}")
        return ""


def switch_all(copy, drawn, chosen):
    """Compiles the chosen ones (by number) behind switches; returns those that could be."""
    switches = {n: switched(drawn[n][1][0], drawn[n][0][2], drawn[n][1][1], n) for n in chosen}
    switches = {n: text for n, text in switches.items() if text}
    judges = sorted({judge for n in switches for judge in judges_of(drawn[n][0][0])})
    while switches:
        for path in {drawn[n][0][0] for n in chosen}:
            copy.write(path, {drawn[n][0][1]: text for n, text in switches.items() if drawn[n][0][0] == path})
        errors = copy.build(judges)
        if not errors:
            break
        bad = {n for n in switches if drawn[n][0][:2] in errors}
        if not bad:
            sys.exit("the copy does not compile: see " + os.path.join(copy.scratch, "build.log"))
        switches = {n: text for n, text in switches.items() if n not in bad}
    for judge in judges if switches else []:
        if who := copy.notice([judge], 0):
            sys.exit("without any change, a test fails: " + who)
    return set(switches)


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

    drawn = draw(arguments.seed)[:4 * arguments.count]
    if arguments.list:
        for number, ((path, line, old), (kind, new)) in enumerate(drawn[:arguments.count], 1):
            print(f"{number:3} {path}:{line + 1} {kind}\n    - {old.strip()}\n    + {new.strip()}")
        return
    only = {int(n) for n in arguments.only.split(",") if n}
    drawn = dict(enumerate(drawn, 1))
    copy = Copy(prepare(arguments.scratch, arguments.cmake), arguments.scratch, arguments.jobs)
    ready = switch_all(copy, drawn, sorted(only) or list(drawn)[:arguments.count])
    tried = noticed = 0
    for by_switch in (True, False):
        for number, ((path, line, old), (kind, new)) in drawn.items():
            if (number in ready) != by_switch or (only and number not in only):
                continue
            if tried == arguments.count:
                break
            judges = judges_of(path)
            if not by_switch:
                copy.write(path, {line: new})
            if not by_switch and copy.build(judges):
                who = None
            else:
                who = copy.notice(judges, number if by_switch else 0)
            copy.write(path, {})
            verdict = "does not compile" if who is None else who or "SURVIVED"
            print(f"{number:3} {path}:{line + 1} {kind}: `{old.strip()}` -> `{new.strip()}`: {verdict}", flush=True)
            tried += who is not None
            noticed += bool(who)
    print(f"{noticed} of {tried} noticed")
    least = arguments.least if not only else 0
    sys.exit(0 if noticed >= least * tried / arguments.count and tried else 1)


if __name__ == "__main__":
    main()
