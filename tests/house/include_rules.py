"""Who may include what.

    core      the standard library, GLM, oneTBB and core/; between its folders, CORE_LAYERS
    proto     of the project, only core/frame/, what compiles kernels, and itself: both ends of the
              wire share it
    server    never client/
    client    never server/, but for the one file that embeds a server in the command line
    all       files of the project by their path from its top, in quotes; only tests include tests/;
              a.cpp includes a.h before all else, and so shows that it needs nothing before it
    headers   begin with #pragma once
"""

import re

# What each folder of core knows besides itself. Lower layers first; only `denoiser` knows all.
# `oracle` stands above it, and is known to it as a FrameFilter.
CORE_LAYERS = {
    "frame": set(),
    "kernels": {"frame"},
    "shading": {"frame", "kernels"},
    "motion": {"frame", "kernels"},
    "radiance": {"frame", "kernels"},
    "history": {"frame", "kernels", "motion", "radiance", "spatial"},
    "spatial": {"frame", "kernels", "radiance"},
    "denoiser": {"frame", "kernels", "shading", "motion", "radiance", "history", "spatial"},
    "oracle": {"frame", "kernels", "shading", "motion", "radiance", "history", "spatial", "denoiser"},
}

CORE_LIBRARIES = ("glm/", "tbb/", "oneapi/tbb/")

PROTO_KNOWS = ("proto/", "holdfast/v1/", "core/frame/", "core/kernels/variants.h", "core/kernels/math.h")

STANDARD_HEADERS = set(
    """
    algorithm any array atomic barrier bit bitset charconv chrono codecvt compare complex
    concepts condition_variable coroutine deque exception execution filesystem format
    forward_list fstream functional future initializer_list iomanip ios iosfwd iostream istream
    iterator latch limits list locale map memory memory_resource mutex new numbers numeric
    optional ostream queue random ranges ratio regex scoped_allocator semaphore set shared_mutex
    source_location span sstream stack stdexcept stop_token streambuf string string_view
    strstream syncstream system_error thread tuple type_traits typeindex typeinfo unordered_map
    unordered_set utility valarray variant vector version cassert cctype cerrno cfenv cfloat
    cinttypes climits clocale cmath csetjmp csignal cstdarg cstddef cstdint cstdio cstdlib
    cstring ctime cuchar cwchar cwctype
    """.split()
)

# The only file of client/ that knows the server, and the only file of server/ that it knows.
EMBEDDING = ("client/cli/embedded_server.cpp", "server/embedded.h")

CODE_FOLDERS = ("core", "proto", "server", "client", "tests")
CODE_SUFFIXES = (".h", ".cpp", ".cu")
OWN_FOLDERS = tuple(f"{folder}/" for folder in CODE_FOLDERS)
GENERATED_PROTOCOL = re.compile(r"holdfast/v\d+/\w+(\.grpc)?\.pb\.h")
INCLUDE = re.compile(r"^\s*#\s*include\s*(?P<what>.*)")
TARGET = re.compile(r'(?P<open>[<"])(?P<path>[^>"]+)[>"]')


def check(tree):
    """Violations as (path, line number, message)."""
    violations = []
    for path in tree.files(CODE_FOLDERS, CODE_SUFFIXES, names=()):
        lines = tree.lines(path)
        includes = [(n, m["what"]) for n, m in enumerate(map(INCLUDE.match, lines), 1) if m]
        for number, what in includes:
            violations += [(path, number, m) for m in _messages(tree, path, what)]
        if path.endswith(".h") and lines[:1] != ["#pragma once"]:
            violations.append((path, 1, "a header begins with #pragma once"))
        violations += _order(tree, path, includes)
    return violations


def _order(tree, path, includes):
    own = path.removesuffix(".cpp") + ".h"
    if not path.endswith(".cpp") or not tree.exists(own):
        return []
    number, first = includes[0] if includes else (1, "")
    return [] if first == f'"{own}"' else [(path, number, f"{own} must be included before all else")]


def _messages(tree, path, what):
    target = TARGET.match(what)
    if not target:
        return [f"include must name a file, but it is {what.strip()}"]
    included, quoted = target["path"], target["open"] == '"'
    messages = []
    if included.startswith(OWN_FOLDERS) and not quoted:
        messages.append(f"{included} is ours: include it in quotes")
    if quoted and not GENERATED_PROTOCOL.fullmatch(included):
        if not included.startswith(OWN_FOLDERS):
            messages.append(f'"{included}" must be a path from the top of the repository')
        elif not tree.exists(included):
            messages.append(f'"{included}" is not there')
    if included.startswith("tests/") and not path.startswith("tests/"):
        messages.append(f"{included}: only tests include tests")
    if path.startswith("core/"):
        messages += _core_messages(path, included, quoted)
    if path.startswith("proto/") and quoted and not included.startswith(PROTO_KNOWS):
        messages.append(f"{included}: proto includes of ours only core/frame/ and kernels' macros")
    if path.startswith("server/") and included.startswith("client/"):
        messages.append(f"{included}: the server never includes the client")
    if path.startswith("client/") and included.startswith("server/"):
        if (path, included) != EMBEDDING:
            only = " includes ".join(EMBEDDING)
            messages.append(f"{included}: the client never includes the server; only {only}")
    return messages


def _core_messages(path, included, quoted):
    if included.startswith("core/"):
        return _layer_messages(_folder(path), _folder(included), included)
    if quoted:
        return [f'"{included}": core includes nothing of ours but core/']
    if included in STANDARD_HEADERS or included.startswith(CORE_LIBRARIES):
        return []
    return [f"<{included}>: core includes the standard library, GLM and oneTBB only"]


def _layer_messages(folder, other, included):
    for name in (folder, other):
        if name not in CORE_LAYERS:
            return [f"core/{name} has no place in CORE_LAYERS of include_rules.py"]
    if other == folder or other in CORE_LAYERS[folder]:
        return []
    allowed = ", ".join(sorted(CORE_LAYERS[folder])) or "nothing else"
    return [f"{included}: core/{folder} knows {allowed}"]


def _folder(path):
    parts = path.split("/")
    return parts[1] if len(parts) > 2 else ""
