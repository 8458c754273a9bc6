#include "core/frame/plane_id.h"

#include <gtest/gtest.h>

namespace holdfast {
namespace {

TEST(PlaneId, EveryNameOfTheFormatParsesBackToItself) {
  for (const char* name :
       {"depth.Z", "normal.X", "normal.Y", "normal.Z", "objectId", "roughness", "albedo.R",
        "specular.G", "emission.B", "motion.X", "motion.Y", "light0.unshadowed.R",
        "light12.visibility", "light0.blockerDistance", "light4294967295.blockerId",
        "light0.sampleU", "light0.sampleV", "glossy.R", "glossy.direction.Z", "glossy.hitDistance",
        "glossy.hitId", "indirect.B", "indirect.direction.X", "gradient.light3.visibility.X",
        "gradient.glossy.Y", "composite.R", "debug.light0.visibility.motion.X",
        "debug.glossy.history", "debug.indirect.confidence"}) {
    const auto ref = channel_from_name(name);
    ASSERT_TRUE(ref) << name;
    EXPECT_EQ(channel_name(ref->plane, ref->channel), name);
    const auto plane = plane_from_name(plane_name(ref->plane));
    ASSERT_TRUE(plane) << name;
    EXPECT_EQ(*plane, ref->plane);
  }
}

TEST(PlaneId, NamesThatAreNotOfTheFormatAreRejected) {
  for (const char* name : {"", "depth", "depth.X", "light.visibility", "light01.visibility",
                           "light-1.visibility", "light4294967296.visibility", "light0.visibility.R",
                           "glossy", "glossy.A", "debug.motion.X", "debug.light0.motion.X",
                           "gradient.light0.X", "composite.A", "objectId.X"})
    EXPECT_FALSE(channel_from_name(name)) << name;
}

}  // namespace
}  // namespace holdfast
