// Streams synthetic frames to a Holdfast server and prints what comes back: a wall that a camera
// faces, under one light whose visibility is noise with a mean of one half.
//
//   stream_frames [host:port | unix:PATH]

#include <cstdio>
#include <cstdlib>
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <holdfast/client.h>

using namespace holdfast;

namespace {

constexpr int kWidth = 320, kHeight = 180, kFrames = 8;
const PlaneId kDepth{PlaneKind::kDepth, {}}, kNormal{PlaneKind::kNormal, {}};
const PlaneId kUnshadowed = PlaneId::of_light(PlaneKind::kUnshadowed, 0);
const PlaneId kVisibility = PlaneId::of_light(PlaneKind::kVisibility, 0);

void fill(ChannelView<float> channel, float value) {
  for (int y = 0; y < channel.height; ++y)
    for (int x = 0; x < channel.width; ++x) channel.at(x, y) = value;
}

Frame make_frame(int index) {
  Frame frame;
  frame.index = index;
  frame.camera.clip_from_view = glm::perspective(0.8, double(kWidth) / kHeight, 0.1, 100.0);
  frame.lights[0] = glm::translate(glm::dmat4(1.0), {0.0, 0.0, 2.0});
  fill(frame.planes.add(kDepth, kWidth, kHeight).channel(0), 5.0f);   // metres
  fill(frame.planes.add(kNormal, kWidth, kHeight).channel(2), 1.0f);  // faces us
  Plane& light = frame.planes.add(kUnshadowed, kWidth, kHeight);
  for (int c = 0; c < 3; ++c) fill(light.channel(c), 0.8f);
  auto visibility = frame.planes.add(kVisibility, kWidth, kHeight).channel(0);
  std::mt19937 random(static_cast<unsigned>(index));
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) visibility.at(x, y) = static_cast<float>(random() & 1u);
  return frame;
}

}  // namespace

int main(int argc, char** argv) try {
  client::prefer_one_poller();
  client::SessionOptions options;
  if (argc > 1) options.address = argv[1];
  options.width = kWidth;
  options.height = kHeight;
  options.lights = {{0, LightShape::kRectangle, 1.0, 1.0, 0.0}};
  options.planes = {kDepth, kNormal, kUnshadowed, kVisibility};

  client::Session session(options);
  for (int i = 0; i < kFrames; ++i) {
    session.submit(make_frame(i));
    const auto output = session.receive();
    if (output->error) throw std::runtime_error(output->error->message);
    const auto result = output->planes.at(kVisibility).channel(0);
    std::printf("frame %d: centre %.3f, core %.2f ms, total %.2f ms\n", i,
                static_cast<double>(result.at(kWidth / 2, kHeight / 2)), output->timing.core,
                output->timing.total);
  }
  session.close();
} catch (const std::exception& error) {
  std::fprintf(stderr, "stream_frames: %s\n", error.what());
  return EXIT_FAILURE;
}
