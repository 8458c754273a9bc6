#include "server/status.h"

#include <gtest/gtest.h>

#include "core/frame/error.h"
#include "holdfast/v1/session_service.pb.h"
#include "server/convert.h"

namespace holdfast::server {
namespace {

grpc::Status status_of(const std::string& subject, const std::string& rule,
                       const std::string& value) {
  return status_from(std::make_exception_ptr(InputError(subject, rule, value)));
}

/// The violation in its details, as a client reads it: only UTF-8 can be read.
v1::InputViolation violation_of(const grpc::Status& status) {
  v1::InputViolation violation;
  EXPECT_TRUE(violation.ParseFromString(status.error_details()));
  return violation;
}

TEST(Status, TextOfAClientIsCutShortSoThatItFitsIntoHeaders) {
  const std::string longest(1u << 20, 'x');
  const grpc::Status status = status_of(longest, longest, longest);
  EXPECT_LT(status.error_message().size() + status.error_details().size() * 4 / 3, 6000u);
  EXPECT_EQ(violation_of(status).value().substr(990), std::string(9, 'x') + "...");
}

TEST(Status, TextThatIsNoUtf8IsMadeReadable) {
  EXPECT_EQ(violation_of(status_of("s", "r", "gr\xc3\xbc\xc3\x9f")).value(), "gr\xc3\xbc\xc3\x9f");
  for (const char* broken : {"\xc3", "\xc3\"", "\x80", "\xff", "\xe0\x80\x80", "\xed\xa0\x80",
                             "\xf0\x80\x80\x80", "\xf4\x90\x80\x80", "\xf0\x9f\x98"})
    EXPECT_EQ(violation_of(status_of("s", "r", broken)).value()[0], '?') << broken;
  const std::string smiles = "\xf0\x9f\x98\x80\xf0\x9f\x98\x80";
  EXPECT_EQ(violation_of(status_of("s", "r", smiles)).value(), smiles);
}

/// Names are quoted up to 64 bytes, wherever that is.
TEST(Status, QuotedNameThatIsCutWithinACharacterCanBeRead) {
  std::string name = "x";
  while (name.size() < 70) name += "\xc3\xbc";
  v1::SessionChange change;
  change.set_recipe(name);
  try {
    changed_config(change, {});
    FAIL();
  } catch (const InputError&) {
    v1::FrameError read;
    EXPECT_TRUE(
        read.ParseFromString(frame_error_from(std::current_exception()).SerializeAsString()));
  }
}

TEST(Status, NamesOfPlanesAreCountedBeforeTheyAreCompared) {
  v1::CreateSessionRequest request;
  request.set_width_px(8);
  request.set_height_px(8);
  for (int i = 0; i < 300000; ++i) request.add_planes("light" + std::to_string(i) + ".visibility");
  try {
    session_config_from(request);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "number of planes must be at most 2048, but it is 300000");
  }
  request.mutable_planes()->DeleteSubrange(1, 299999);
  for (int i = 0; i < 300000; ++i) request.add_result_planes("composite");
  EXPECT_THROW(session_config_from(request), InputError);
}

}  // namespace
}  // namespace holdfast::server
