#include "tests/stability/fuzz_message.h"

#include "client/sdk/frame_sender.h"
#include "holdfast/v1/denoise_service.pb.h"
#include "tests/service/test_frames.h"

namespace holdfast::test {
namespace {

std::uint64_t wrong_number(std::uint64_t right, Random& random) {
  constexpr std::uint64_t kValues[] = {0,          1,          3,          4,          1u << 20,
                                       0x7fffffff, 0xffffffff, 1ull << 33, ~0ull >> 1, ~0ull};
  if (chance(random, 0.5)) return kValues[below(random, std::size(kValues))];
  return right + below(random, 9) - 4;
}

void damage_chunk(v1::PlaneChunk& chunk, Random& random) {
  switch (below(random, 6)) {
    case 0: chunk.set_plane(static_cast<std::uint32_t>(wrong_number(chunk.plane(), random))); break;
    case 1: chunk.set_offset(wrong_number(chunk.offset(), random)); break;
    case 2: chunk.set_last(!chunk.last()); break;
    case 3:
      chunk.set_plain_bytes(static_cast<std::uint32_t>(wrong_number(chunk.plain_bytes(), random)));
      break;
    case 4: chunk.mutable_data()->resize(below(random, 2 * chunk.data().size() + 5)); break;
    default: chunk.set_data(damaged(chunk.data(), random));
  }
}

void damage_begin(v1::FrameBegin& begin, Random& random) {
  const auto number = [&](std::uint64_t right) {
    return static_cast<std::uint32_t>(wrong_number(right, random));
  };
  v1::FramePlane* const plane =
      begin.planes().empty()
          ? begin.add_planes()
          : begin.mutable_planes(static_cast<int>(below(random, begin.planes().size())));
  switch (below(random, 14)) {
    case 0: plane->set_plane(number(plane->plane())); break;
    case 1: plane->set_width_px(number(plane->width_px())); break;
    case 2: plane->set_height_px(number(plane->height_px())); break;
    case 3: plane->set_format(static_cast<v1::PlaneFormat>(number(plane->format()))); break;
    case 4: plane->set_codec(static_cast<v1::PlaneCodec>(number(plane->codec()))); break;
    case 5: *begin.add_planes() = *plane; break;
    case 6: begin.mutable_planes()->RemoveLast(); break;
    case 7: begin.clear_camera(); break;
    case 8: begin.mutable_camera()->mutable_clip_from_view()->add_values(1); break;
    case 9: begin.set_deadline_ms(chance(random, 0.5) ? -1 : HUGE_VAL); break;
    case 10: begin.add_lights()->set_id(number(0)); break;
    case 11: begin.add_objects()->set_id(number(0)); break;
    case 12: begin.mutable_change()->set_width_px(number(1)); break;
    default: begin.set_index(static_cast<std::int64_t>(wrong_number(0, random)));
  }
}

/// Another value in a field, where the message can be read at all.
void damage_field(std::string& bytes, Random& random) {
  v1::DenoiseRequest request;
  if (!request.ParseFromString(bytes)) return;
  if (request.has_plane_chunk()) damage_chunk(*request.mutable_plane_chunk(), random);
  if (request.has_frame_begin()) damage_begin(*request.mutable_frame_begin(), random);
  if (request.has_frame_end())
    request.mutable_frame_end()->set_index(static_cast<std::int64_t>(wrong_number(0, random)));
  bytes = request.SerializeAsString();
}

void damage_list(std::vector<std::string>& messages, Random& random) {
  if (messages.empty()) return;
  const std::size_t at = below(random, messages.size());
  const auto place = messages.begin() + static_cast<std::ptrdiff_t>(at);
  switch (below(random, 10)) {
    case 0: messages.erase(place); break;
    case 1: messages.insert(place, std::string(*place)); break;
    case 2: std::swap(*place, messages[below(random, messages.size())]); break;
    case 3: messages.resize(at); break;
    case 4: *place += std::string(messages[below(random, messages.size())]); break;  // fields twice
    case 5: *place = damaged(*place, random); break;
    case 6:
      if (chance(random, 0.3)) place->clear();
      break;
    default: damage_field(*place, random);
  }
}

}  // namespace

grpc::ByteBuffer in_pieces(const std::string& bytes, Random& random) {
  std::vector<grpc::Slice> slices;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t most = chance(random, 0.3) ? 3 : 4000;
    const std::size_t size = std::min(below(random, most), bytes.size() - at);
    slices.emplace_back(bytes.data() + at, size);
    at += size;
  }
  return grpc::ByteBuffer(slices.data(), slices.size());
}

DenoiserConfig fuzz_session_config(Random& random) {
  DenoiserConfig config = small_config(1 + static_cast<int>(below(random, 40)),
                                       1 + static_cast<int>(below(random, 24)));
  for (const PlaneKind kind : {PlaneKind::kAlbedo, PlaneKind::kIndirect,
                               PlaneKind::kIndirectDirection, PlaneKind::kEmission})
    if (chance(random, 0.5)) config.planes.push_back({kind, {}});
  return config;
}

std::string any_wire(Random& random) {
  return wire::profile_names()[below(random, wire::profile_names().size())];
}

std::vector<std::string> frame_messages(const Frame& frame, const DenoiserConfig& config,
                                        const std::string& wire) {
  client::PlaneWriter writer{wire::find_profile(wire), {}};
  client::FrameSender sender({{&frame, [](const Frame*) {}}, 0, {}, {}}, config.planes, writer);
  std::vector<std::string> out;
  wire::OutgoingMessage message;
  while (sender.next(message)) {
    std::vector<grpc::Slice> slices;
    if (!message.bytes.Dump(&slices).ok()) return {};
    std::string& bytes = out.emplace_back();
    for (const grpc::Slice& slice : slices)
      bytes.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
  }
  return out;
}

std::vector<std::string> damaged_messages(std::vector<std::string> messages, Random& random) {
  for (std::size_t n = 1 + below(random, 4); n > 0; --n) damage_list(messages, random);
  return messages;
}

}  // namespace holdfast::test
