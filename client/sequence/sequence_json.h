#pragma once

#include <filesystem>
#include <vector>

#include "client/sequence/sequence.h"

namespace holdfast {

/// The content of a sequence.json; frames have no planes.
struct SequenceDescription {
  SequenceHeader header;
  std::vector<Frame> frames;
};

/// Reads sequence.json, version 1. Throws InputError naming file, key, rule and value for: a
/// missing or unknown key, a wrong type or range, indices that do not increase, an id listed twice,
/// a light that the header does not list, no frame at all.
SequenceDescription read_sequence_json(const std::filesystem::path& file);

/// Writes sequence.json, version 1. Throws std::runtime_error if the file cannot be written.
void write_sequence_json(const std::filesystem::path& file, const SequenceHeader& header,
                         const std::vector<Frame>& frames);

/// Checks sizes, rates and ids; throws InputError with `subject` as the thing that is wrong.
void check_header(const SequenceHeader& header, const std::string& subject);

}  // namespace holdfast
