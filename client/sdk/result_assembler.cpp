#include "client/sdk/result_assembler.h"

#include "client/sdk/convert.h"

namespace holdfast::client {
namespace {

void require(bool condition, const char* rule) {
  if (!condition) throw std::runtime_error(std::string("the server broke the protocol: ") + rule);
}

}  // namespace

bool ResultAssembler::begin(const v1::FrameResult& result, PlaneSize of, PlaneSet&& reuse) {
  require(!output_, "an answer began inside another");
  output_.emplace();
  read_frame_result(result, *output_);
  plane_ = 0;
  received_ = 0;
  if (output_->error || output_->dropped) return true;
  require(result.planes_size() == static_cast<int>(results_.size()),
          "an answer must announce all result planes");
  output_->planes = std::move(reuse);
  codings_.clear();
  for (std::size_t i = 0; i < results_.size(); ++i) {
    const PlaneId id = results_[i];
    const v1::FramePlane& announced = result.planes(static_cast<int>(i));
    require(announced.plane() == i, "result planes must be announced in their order");
    const auto format = wire::format_from_number(announced.format(), id.kind);
    const auto codec = wire::codec_from_number(announced.codec());
    require(format && codec, "a result plane must have a known codec and a format that suits it");
    codings_.push_back({*format, *codec});
    const PlaneSize size = plane_size(id, of.width, of.height);
    output_->planes.add(id, size.width, size.height);
  }
  return results_.empty();
}

bool ResultAssembler::add(const wire::ChunkView& chunk) {
  const auto& [number, offset, last, plain_bytes, shared_bytes] = chunk.fields;
  require(output_.has_value(), "a chunk came outside an answer");
  require(number == plane_ && offset == received_,
          "chunks must come in the order of the planes, without gaps");
  Plane& plane = *output_->planes.find(results_[plane_]);
  const wire::PlaneCoding coding = codings_[plane_];
  const bool coded = coding.codec != wire::Codec::kNone;
  const std::uint64_t size = wire::plane_bytes(plane, coding.format);
  const std::uint64_t bytes = coded ? plain_bytes : chunk.data_bytes;
  require(bytes > 0 && bytes % wire::element_bytes(coding.format) == 0 &&
              bytes <= wire::kMaxChunkBytes && bytes <= size - received_,
          "a chunk must lie within its plane");
  require(coder_.decode(plane, coding, received_, bytes, chunk.data, chunk.shared),
          "a chunk must be what its codec makes");
  received_ += bytes;
  require(last == (received_ == size), "the last chunk must end its plane");
  if (received_ < size) return false;
  received_ = 0;
  return ++plane_ == results_.size();
}

FrameOutput ResultAssembler::take() {
  FrameOutput output = std::move(*output_);
  output_.reset();
  return output;
}

}  // namespace holdfast::client
