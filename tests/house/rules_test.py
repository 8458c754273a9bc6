"""The house rules catch what they are there for, and let pass what is allowed."""

import tempfile
import unittest
from pathlib import Path

import include_rules
import lanes
import text_rules
from source_tree import SourceTree


class RulesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.tree = SourceTree(folder.name)

    def write(self, path, text=""):
        file = Path(self.tree.root, path)
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")

    def includes(self, path, line):
        """Messages about one include line in a file of that path."""
        self.write(path, f"#pragma once\n{line}\n")
        found = include_rules.check(self.tree)
        return [message for file, number, message in found if (file, number) == (path, 2)]

    def allowed(self, path, line):
        self.assertEqual(self.includes(path, line), [])

    def refused(self, path, line, part):
        messages = self.includes(path, line)
        self.assertTrue(any(part in m for m in messages), f"{part!r} not in {messages}")


class Includes(RulesTest):
    def test_core_may_include_std_glm_tbb_and_lower_layers(self):
        self.write("core/frame/plane.h")
        self.allowed("core/frame/a.h", "#include <vector>")
        self.allowed("core/frame/a.h", "#include <glm/glm.hpp>")
        self.allowed("core/kernels/a.h", "#include <tbb/parallel_for.h>")
        self.allowed("core/kernels/a.h", "#include <oneapi/tbb/task_arena.h>")
        self.allowed("core/spatial/a.cpp", '#include "core/frame/plane.h"')
        self.allowed("core/denoiser/a.cpp", '#include "core/frame/plane.h"')

    def test_core_may_not_include_other_libraries(self):
        for header in ("spdlog/spdlog.h", "grpcpp/grpcpp.h", "embree3/rtcore.h", "unistd.h"):
            self.refused("core/frame/a.cpp", f"#include <{header}>", "standard library")

    def test_core_may_not_include_server_client_or_protocol(self):
        self.write("server/a.h")
        self.write("client/sdk/a.h")
        self.refused("core/denoiser/a.cpp", '#include "server/a.h"', "but core/")
        self.refused("core/denoiser/a.cpp", '#include "client/sdk/a.h"', "but core/")
        self.refused("core/denoiser/a.cpp", '#include "holdfast/v1/frame.pb.h"', "but core/")

    def test_every_core_folder_refuses_every_folder_that_it_does_not_know(self):
        for other in include_rules.CORE_LAYERS:
            self.write(f"core/{other}/b.h")
        for folder, known in include_rules.CORE_LAYERS.items():
            for other in include_rules.CORE_LAYERS:
                line = f'#include "core/{other}/b.h"'
                if other == folder or other in known:
                    self.allowed(f"core/{folder}/a.h", line)
                else:
                    self.refused(f"core/{folder}/a.h", line, f"core/{folder} knows")

    def test_layers_have_no_cycle(self):
        for folder, known in include_rules.CORE_LAYERS.items():
            for other in known:
                self.assertNotIn(folder, include_rules.CORE_LAYERS[other])

    def test_new_core_folder_needs_a_place_in_the_table(self):
        self.write("core/frame/plane.h")
        self.refused("core/magic/a.h", '#include "core/frame/plane.h"', "no place in CORE_LAYERS")

    def test_proto_knows_the_frame_and_nothing_else_of_ours(self):
        self.write("core/frame/plane.h")
        self.write("core/kernels/variants.h")
        self.write("core/kernels/parallel.h")
        self.write("core/denoiser/denoiser.h")
        self.write("server/session.h")
        self.allowed("proto/chunk.cpp", '#include "holdfast/v1/denoise_service.pb.h"')
        self.allowed("proto/bytes.h", '#include "core/frame/plane.h"')
        self.allowed("proto/rows.cpp", '#include "core/kernels/variants.h"')
        self.refused("proto/rows.cpp", '#include "core/kernels/parallel.h"', "only core/frame/")
        self.refused("proto/bytes.h", '#include "core/denoiser/denoiser.h"', "only core/frame/")
        self.refused("proto/bytes.h", '#include "server/session.h"', "only core/frame/")
        self.refused("core/frame/a.h", '#include "proto/bytes.h"', "but core/")

    def test_server_and_client_never_include_each_other(self):
        self.write("server/session.h")
        self.write("client/sdk/client.h")
        self.refused("server/a.cpp", '#include "client/sdk/client.h"', "never includes the client")
        self.refused("client/cli/a.cpp", '#include "server/session.h"', "never includes the server")

    def test_only_the_embedding_file_knows_only_the_embedding_header(self):
        self.write("server/embedded.h")
        self.write("server/session.h")
        self.allowed("client/cli/embedded_server.cpp", '#include "server/embedded.h"')
        reason = "never includes the server"
        self.refused("client/cli/embedded_server.cpp", '#include "server/session.h"', reason)
        self.refused("client/cli/replay.cpp", '#include "server/embedded.h"', reason)

    def test_own_headers_are_quoted_whole_paths_of_files_that_exist(self):
        self.write("core/frame/plane.h")
        self.refused("core/frame/a.cpp", '#include "plane.h"', "from the top")
        self.refused("server/a.cpp", '#include "../core/frame/plane.h"', "from the top")
        self.refused("server/a.cpp", "#include <core/frame/plane.h>", "in quotes")
        self.refused("server/a.cpp", '#include "core/frame/missing.h"', "is not there")
        self.allowed("server/a.cpp", '#include "holdfast/v1/frame.grpc.pb.h"')
        self.write("server/version.h.in")
        self.allowed("server/a.cpp", '#include "server/version.h"')

    def test_unusual_spelling_hides_nothing(self):
        self.write("client/sdk/a.h")
        self.refused("core/frame/a.cpp", "  #  include<spdlog/spdlog.h>", "standard library")
        self.refused("server/a.cpp", '#include"client/sdk/a.h" // why', "never includes the client")
        self.refused("server/a.cpp", "#include HEADER", "must name a file")

    def test_own_header_comes_first(self):
        self.write("server/a.h", "#pragma once\n")
        for text, violations in (
            ('#include "server/a.h"\n\n#include <vector>\n', 0),
            ('// What it is.\n#include "server/a.h"\n', 0),
            ('#include <vector>\n#include "server/a.h"\n', 1),
            ("int a;\n", 1),
        ):
            self.write("server/a.cpp", text)
            found = [m for path, _, m in include_rules.check(self.tree) if path == "server/a.cpp"]
            self.assertEqual(len(found), violations, text)

    def test_headers_begin_with_pragma_once(self):
        self.write("server/a.h", "#pragma once\n")
        self.assertEqual(include_rules.check(self.tree), [])
        for text in ("", "\n#pragma once\n", "#ifndef A\n"):
            self.write("server/a.h", text)
            self.assertEqual(len(include_rules.check(self.tree)), 1, text)

    def test_only_tests_include_tests(self):
        self.write("tests/core/oracle.h")
        self.allowed("tests/core/a.cpp", '#include "tests/core/oracle.h"')
        self.refused("client/cli/a.cpp", '#include "tests/core/oracle.h"', "only tests")


class Text(RulesTest):
    def test_file_of_the_longest_allowed_length_passes_and_one_line_more_fails(self):
        self.write("core/frame/a.cpp", "\n" * text_rules.MAX_LINES)
        self.assertEqual(text_rules.check_length(self.tree), [])
        self.write("core/frame/a.cpp", "\n" * (text_rules.MAX_LINES + 1))
        self.assertEqual(len(text_rules.check_length(self.tree)), 1)

    def test_every_marker_is_found_in_every_kind_of_file(self):
        for path in ("core/frame/a.h", "server/a.cpp", "proto/a.proto", "tests/a.py", "deploy/a.sh",
                     "cmake/a.cmake", "CMakeLists.txt", "core/CMakeLists.txt"):
            for word in text_rules.markers():
                self.write(path, f"line\n// {word}: finish\n")
                hits = [v for v in text_rules.check_markers(self.tree) if v[:2] == (path, 2)]
                self.assertTrue(hits, f"{word} in {path}")

    def test_markers_inside_other_words_are_no_findings(self):
        for word in text_rules.markers():
            self.write("core/frame/a.h", f"a{word}b {word}{word}\n")
            self.assertEqual(text_rules.check_markers(self.tree), [], word)

    def test_generated_folders_are_left_out(self):
        marker = text_rules.markers()[0]
        self.write("core/shading/generated/table.h", f"{marker}\n" * (text_rules.MAX_LINES + 1))
        self.assertEqual(text_rules.check_markers(self.tree), [])
        self.assertEqual(text_rules.check_length(self.tree), [])


class Lanes(unittest.TestCase):
    def count(self, name, *instructions):
        lines = [f"0000000000501300 <{name}>:"] + [f"  501300:\t{i}" for i in instructions]
        return lanes.kernels_of(lines + ["", "0000000000501400 <main>:", "  501400:\tret"])

    def test_arithmetic_on_512_bits_is_counted(self):
        name = "holdfast::(anonymous namespace)::sum_v4(holdfast::Row const&)"
        self.assertEqual(self.count(name, "vaddps %zmm0,%zmm1,%zmm2", "vmulss %xmm0,%xmm1,%xmm2"),
                         {name: 1})

    def test_moves_and_single_values_are_not(self):
        name = "holdfast::(anonymous namespace)::sum_v4(holdfast::Row const&)"
        self.assertEqual(self.count(name, "vmovups (%rdi),%zmm0", "vaddss %xmm0,%xmm1,%xmm2",
                                    "vpxor %zmm1,%zmm1,%zmm1"), {name: 0})

    def test_other_functions_do_not_count(self):
        self.assertEqual(self.count("holdfast::sum(holdfast::Row const&)", "vaddps %zmm0,%zmm1,%zmm2"), {})


if __name__ == "__main__":
    unittest.main()
