#include "tests/stability/fuzz_damage.h"

#include <algorithm>
#include <cctype>
#include <cstring>

namespace holdfast::test {
namespace {

/// A place, and how many bytes from there on: mostly few.
struct Span {
  std::size_t at, size;
};

Span some(const std::string& bytes, Random& random) {
  const std::size_t at = below(random, bytes.size() + 1);
  const std::size_t most = chance(random, 0.8) ? 8 : bytes.size();
  return {at, std::min(below(random, most + 1), bytes.size() - at)};
}

/// Little-endian numbers at which sizes overflow or turn negative.
std::string extreme_number(Random& random) {
  constexpr std::uint64_t kValues[] = {
      0,          1,          0x7f,       0x80,       0xff,       0x7fff,     0xffff,     0x10000,
      0x7fffffff, 0x80000000, 0xffffffff, 0xfffffffe, 1ull << 32, 1ull << 62, ~0ull >> 1, ~0ull};
  const std::uint64_t value = kValues[below(random, std::size(kValues))];
  std::string bytes(chance(random, 0.7) ? 4 : 8, '\0');
  std::memcpy(bytes.data(), &value, bytes.size());
  return bytes;
}

void damage_once(std::string& bytes, Random& random, std::span<const std::string_view> words) {
  const Span part = some(bytes, random);
  switch (below(random, 9)) {
    case 0:
    case 1:
      if (part.at < bytes.size())
        bytes[part.at] = static_cast<char>(bytes[part.at] ^ (1 << below(random, 8)));
      break;
    case 2:
      for (std::size_t i = 0; i < part.size; ++i)
        bytes[part.at + i] = static_cast<char>(random.bits());
      break;
    case 3: bytes.erase(part.at, part.size); break;
    case 4: bytes.insert(part.at, bytes.substr(part.at, part.size)); break;
    case 5: bytes.insert(below(random, bytes.size() + 1), bytes.substr(part.at, part.size)); break;
    case 6:
      if (chance(random, 0.3)) bytes.resize(part.at);
      break;
    case 7: {
      const std::string number = extreme_number(random);
      if (part.at + number.size() <= bytes.size()) bytes.replace(part.at, number.size(), number);
      break;
    }
    default:
      if (!words.empty())
        bytes.replace(part.at, part.size, std::string(words[below(random, words.size())]));
  }
}

std::string nested(std::size_t depth, char open, char close, bool closed) {
  std::string text;
  for (std::size_t i = 0; i < depth; ++i) text += open == '{' ? "{\"a\":" : std::string(1, open);
  text += '1';
  if (closed) text.append(depth, close);
  return text;
}

/// A token that may be right at some places, and is wrong at most.
std::string other_token(Random& random) {
  constexpr std::string_view kTokens[] = {"null",
                                          "true",
                                          "false",
                                          "0",
                                          "-0.0",
                                          "-1",
                                          "1e9",
                                          "1000000000",
                                          "4294967295",
                                          "1e40",
                                          "1e308",
                                          "-1e308",
                                          "1e-320",
                                          "1e999",
                                          "NaN",
                                          "Infinity",
                                          "-inf",
                                          "0x10",
                                          "18446744073709551615",
                                          "-9223372036854775808",
                                          "99999999999999999999999",
                                          "0.5",
                                          "16385",
                                          "[]",
                                          "{}",
                                          "\"\"",
                                          "\"x\"",
                                          "\"\\u0000\"",
                                          "\"\\ud800\"",
                                          "\"\xff\xfe\"",
                                          "\"\xc3\"",
                                          "'x'",
                                          "/*x*/",
                                          ",",
                                          ":",
                                          "]",
                                          "}",
                                          "[",
                                          "{",
                                          "[1,2]",
                                          "[1,2,3]",
                                          "[[1],2,3]",
                                          "[1e300,1e300,1e300]",
                                          "[1e-200,1e-200,1e-200]",
                                          "[0,0,0,0]",
                                          "\"id\"",
                                          "\"__proto__\""};
  const double kind = random.uniform();
  if (kind < 0.02) return nested(chance(random, 0.5) ? 200000 : 70, '[', ']', chance(random, 0.7));
  if (kind < 0.04) return nested(chance(random, 0.5) ? 100000 : 70, '{', '}', chance(random, 0.7));
  if (kind < 0.05) return '"' + std::string(100000, 'x') + '"';
  if (kind < 0.06) return '[' + std::string(100000, '0') + ']';
  if (kind < 0.07) return "1" + std::string(100000, '0');
  return std::string(kTokens[below(random, std::size(kTokens))]);
}

/// Where what begins with the token at `from` ends: behind it, or behind the bracket that closes
/// it.
std::size_t end_of(const std::vector<std::string>& tokens, std::size_t from) {
  std::size_t at = from, depth = 0;
  do {
    if (tokens[at] == "[" || tokens[at] == "{") ++depth;
    if (depth > 0 && (tokens[at] == "]" || tokens[at] == "}")) --depth;
    ++at;
  } while (depth > 0 && at < tokens.size());
  return at;
}

void damage_tokens(std::vector<std::string>& tokens, Random& random) {
  if (tokens.empty()) return;
  const std::size_t at = below(random, tokens.size()), end = end_of(tokens, at);
  const auto begin = tokens.begin();
  const auto place = [&](std::size_t i) { return begin + static_cast<std::ptrdiff_t>(i); };
  switch (below(random, 6)) {
    case 0:
    case 1: tokens[at] = other_token(random); break;
    case 2:  // a value with all that it encloses
      tokens[at] = other_token(random);
      tokens.erase(place(at + 1), place(std::max(end, at + 1)));
      break;
    case 3: tokens.erase(place(at), place(end)); break;
    case 4: std::swap(tokens[at], tokens[below(random, tokens.size())]); break;
    default: {
      const std::vector<std::string> copy(place(at), place(end));
      tokens.insert(place(below(random, tokens.size() + 1)), copy.begin(), copy.end());
    }
  }
}

}  // namespace

std::size_t below(Random& random, std::size_t count) {
  return static_cast<std::size_t>(random.uniform() * static_cast<double>(count));
}

std::string damaged(std::string bytes, Random& random, std::span<const std::string_view> words) {
  for (std::size_t n = 1 + below(random, chance(random, 0.7) ? 2 : 12); n > 0; --n)
    damage_once(bytes, random, words);
  return bytes;
}

std::vector<std::string> json_tokens(std::string_view text) {
  std::vector<std::string> tokens;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t from = at++;
    const auto is_word = [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' || c == '+';
    };
    if (std::isspace(static_cast<unsigned char>(text[from])) != 0) continue;
    if (text[from] == '"') {
      while (at < text.size() && text[at] != '"') at += text[at] == '\\' ? 2 : 1;
      at = std::min(at + 1, text.size());
    } else if (is_word(text[from])) {
      while (at < text.size() && is_word(text[at])) ++at;
    }
    tokens.emplace_back(text.substr(from, at - from));
  }
  return tokens;
}

std::string damaged_json(std::string_view text, Random& random) {
  std::vector<std::string> tokens = json_tokens(text);
  for (std::size_t n = 1 + below(random, 3); n > 0; --n) damage_tokens(tokens, random);
  std::string out;
  for (const std::string& token : tokens) out += token + (chance(random, 0.05) ? "\n" : "");
  return out;
}

}  // namespace holdfast::test
