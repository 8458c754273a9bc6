#include "client/cli/study_wire.h"

#include <cmath>
#include <limits>
#include <optional>

#include <holdfast/client.h>

#include "client/cli/embedded_server.h"
#include "client/cli/percentiles.h"
#include "client/cli/progress.h"
#include "client/cli/thread_time.h"
#include "client/cli/wire_trip.h"
#include "client/measure/judged.h"
#include "client/measure/layer_meter.h"
#include "client/sequence/sequence.h"
#include "proto/wire_profile.h"

namespace holdfast::cli {
namespace {

/// Costs of one direction: encodes and decodes frames as both ends of a stream do.
class CostMeter {
 public:
  explicit CostMeter(const WireCodings& codings) : trip_(codings) {}

  /// `pixels`: of the frame.
  void add(const PlaneSet& planes, const std::vector<PlaneId>& ids, double pixels) {
    double encode = 0, decode = 0;
    for (const PlaneId id : ids) {
      const Plane& plane = planes.at(id);
      WireCost& sum = sums_[id];
      const double start = 1e6 * thread_ms();
      trip_.encode(plane);
      const double middle = 1e6 * thread_ms();
      Plane& decoded = decoded_.add(id, plane.width(), plane.height());
      const double restart = 1e6 * thread_ms();  // what `add` allocates is not counted
      trip_.decode(decoded);
      const double decode_ns = 1e6 * thread_ms() - restart;
      sum.encode_ns += middle - start;
      sum.decode_ns += decode_ns;
      encode += middle - start;
      decode += decode_ns;
      sum.plain_bytes += static_cast<double>(trip_.plain_bytes());
      sum.coded_bytes += static_cast<double>(trip_.coded_bytes());
    }
    pixels_ += pixels;
    encode_ns_.push_back(encode / pixels);
    decode_ns_.push_back(decode / pixels);
  }

  std::map<PlaneId, WireCost> planes() const {
    auto out = sums_;
    for (auto& [id, cost] : out) {
      cost.plain_bytes /= pixels_;
      cost.coded_bytes /= pixels_;
      cost.encode_ns /= pixels_;
      cost.decode_ns /= pixels_;
    }
    return out;
  }

  WireCost total() const {
    WireCost out{0, 0, percentile(encode_ns_, 0.5), percentile(decode_ns_, 0.5)};
    for (const auto& [id, cost] : planes()) {
      out.plain_bytes += cost.plain_bytes;
      out.coded_bytes += cost.coded_bytes;
    }
    return out;
  }

 private:
  WireTrip trip_;
  PlaneSet decoded_;
  std::map<PlaneId, WireCost> sums_;
  std::vector<double> encode_ns_, decode_ns_;
  double pixels_ = 0;
};

/// Mean squared difference of judged values over surface pixels.
class ErrorMeter {
 public:
  void add(const Plane& a, const Plane& b, const measure::Mask& surface) {
    const auto measure = measure::measure_of(a.id().kind);
    const auto judged = [&](const Plane& plane) {
      return measure::judged_image(measure::clean_image(plane).image, measure);
    };
    const auto squared = measure::squared_difference(judged(a), judged(b));
    for (std::size_t i = 0; i < surface.size(); ++i)
      if (surface[i]) {
        sum_ += squared[i];
        count_ += a.channels();
      }
  }
  double rmse() const {
    return count_ > 0 ? std::sqrt(sum_ / count_) : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  double sum_ = 0, count_ = 0;
};

/// One sequence under one profile after the other.
class SequenceStudy {
 public:
  SequenceStudy(const std::filesystem::path& dir, const WireStudyOptions& options,
                const std::string& address, Progress& progress)
      : sequence_(dir), options_(options), address_(address), progress_(progress) {}

  WireFigures run(const wire::WireProfile& profile, std::int64_t& done) {
    const auto indices = sequence_.frame_indices();
    client::Session session(session_options(profile));
    CostMeter up(profile.input), down(profile.result);
    struct Errors {
      ErrorMeter exact, reference;
    };
    std::map<PlaneId, Errors> errors;
    const bool first = exact_.empty();
    for (std::size_t i = 0; i < indices.size(); ++i) {
      const auto frame = std::make_shared<const Frame>(sequence_.read_frame(indices[i]));
      PlaneSet answered = answer(session, frame);
      const PlaneSet& results = first ? exact_.emplace_back(std::move(answered)) : answered;
      const Plane& depth = frame->planes.at({PlaneKind::kDepth, {}});
      const double pixels = static_cast<double>(depth.width()) * depth.height();
      up.add(frame->planes, sequence_.planes(), pixels);
      down.add(exact_[i], session.results(),
               pixels);  // before any rounding, as the server has them
      const measure::Mask surface = measure::surface_mask(depth);
      const PlaneSet references =
          sequence_.has_reference(indices[i]) ? sequence_.read_reference(indices[i]) : PlaneSet();
      for (const PlaneId id : session.results()) {
        errors[id].exact.add(results.at(id), exact_[i].at(id), surface);
        if (const Plane* reference = references.find(id))
          errors[id].reference.add(results.at(id), *reference, surface);
      }
      progress_.update(++done);
    }
    session.close();
    WireFigures out{sequence_.dir().string(),
                    std::string(profile.name),
                    up.total(),
                    down.total(),
                    up.planes(),
                    down.planes(),
                    {}};
    for (const auto& [id, error] : errors) {
      const double rmse = error.exact.rmse();
      out.layers[id] = {-20 * std::log10(rmse), rmse, error.reference.rmse()};
    }
    return out;
  }

 private:
  client::SessionOptions session_options(const wire::WireProfile& profile) const {
    client::SessionOptions out;
    out.address = address_;
    out.width = sequence_.header().width;
    out.height = sequence_.header().height;
    out.lights = sequence_.header().lights;
    out.planes = sequence_.planes();
    out.recipe = options_.recipe;
    out.preset = options_.preset;
    out.wire = profile.name;
    return out;
  }

  static PlaneSet answer(client::Session& session, const std::shared_ptr<const Frame>& frame) {
    session.submit(frame);
    auto output = session.receive();
    if (!output) throw std::runtime_error("the server gave no answer");
    if (output->error && output->error->input) throw *output->error->input;
    if (output->error) throw std::runtime_error(output->error->message);
    return std::move(output->planes);
  }

  const SequenceReader sequence_;
  const WireStudyOptions& options_;
  const std::string& address_;
  Progress& progress_;
  std::vector<PlaneSet> exact_;  ///< results of the first profile, by frame
};

}  // namespace

std::vector<WireFigures> study_wire(const WireStudyOptions& options) {
  const EmbeddedServer server(0);
  const auto& names = wire::profile_names();
  std::int64_t total = 0, done = 0;
  for (const auto& dir : options.sequences)
    total += static_cast<std::int64_t>(SequenceReader(dir).frame_indices().size() * names.size());
  Progress progress("wire", total, options.quiet);
  std::vector<WireFigures> figures;
  for (const auto& dir : options.sequences) {
    SequenceStudy study(dir, options, server.address(), progress);
    for (const std::string& name : names)
      figures.push_back(study.run(*wire::find_profile(name), done));
  }
  return figures;
}

}  // namespace holdfast::cli
