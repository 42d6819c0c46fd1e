// Sounds: samples, times and balances by closed forms; damaged files are errors. Targets of requests: whatever comes,
// nothing leads out.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "runtime/base/error.hpp"
#include "runtime/store/request_target.hpp"
#include "runtime/store/sound.hpp"

namespace breve {
namespace {

constexpr std::uint32_t kRate = 8000;

void put_number(std::string& bytes, std::uint32_t number, int size) {
  for (int i = 0; i < size; ++i) bytes += static_cast<char>(number >> (8 * i) & 255);
}

/// A WAV file of 16 bits: in each channel a ramp of its own, so that each sample tells where it stood.
std::string wav(std::uint32_t channels, std::uint32_t frames) {
  std::string bytes = "RIFF";
  const std::uint32_t size = 2 * channels * frames;
  put_number(bytes, 36 + size, 4);
  bytes += "WAVEfmt ";
  put_number(bytes, 16, 4);
  put_number(bytes, 1, 2);
  put_number(bytes, channels, 2);
  put_number(bytes, kRate, 4);
  put_number(bytes, kRate * 2 * channels, 4);
  put_number(bytes, 2 * channels, 2);
  put_number(bytes, 16, 2);
  bytes += "data";
  put_number(bytes, size, 4);
  for (std::uint32_t i = 0; i < frames; ++i)
    for (std::uint32_t c = 0; c < channels; ++c) put_number(bytes, (c + 1) * 16 * i, 2);
  return bytes;
}

double sample_at(double frame, std::uint32_t channel) { return 16 * (channel + 1) * frame / 32768; }

PlayedSound played(std::uint32_t channels, std::uint32_t frames) {
  PlayedSound sound(std::pmr::get_default_resource());
  sound.samples = Samples::parse(wav(channels, frames), "ramp.wav");
  return sound;
}

std::vector<float> heard(const auto& source, double start, double rate, std::size_t frames) {
  std::vector<float> samples(2 * frames);
  source.add_to(samples, {start, rate});
  return samples;
}

class SoundFile : public testing::Test {
 protected:
  void SetUp() override {
    try {
      (void)Samples::parse(wav(1, 2), "ramp.wav");
    } catch (const Error& error) {
      GTEST_SKIP() << error.what();  // built without files
    }
  }
};

TEST_F(SoundFile, IsHeardOnBothSidesFromTheTimeItStartsUntilItEnds) {
  PlayedSound sound = played(1, 100);
  EXPECT_EQ(sound.samples.rate(), kRate);
  EXPECT_EQ(sound.samples.frames(), 100U);
  EXPECT_DOUBLE_EQ(sound.samples.seconds(), 100.0 / kRate);
  sound.play(1, 1);
  EXPECT_TRUE(sound.sounds_at(1));
  EXPECT_FALSE(sound.sounds_at(1.0125));
  // Ten frames of silence, a hundred of sound, ten of silence.
  const auto samples = heard(sound, 1 - 10.0 / kRate, kRate, 120);
  for (std::size_t i = 0; i < 120; ++i) {
    const double expected = i < 10 || i >= 110 ? 0 : sample_at(static_cast<double>(i) - 10, 0);
    EXPECT_NEAR(samples[2 * i], expected, 1e-6) << i;
    EXPECT_EQ(samples[2 * i], samples[2 * i + 1]);
  }
}

TEST_F(SoundFile, OfTwoChannelsHasLeftAndRightAndOfMoreTheFirstTwo) {
  for (const std::uint32_t channels : {2U, 6U}) {
    PlayedSound sound = played(channels, 50);
    sound.play(0, 1);
    const auto samples = heard(sound, 0, kRate, 50);
    for (std::size_t i = 0; i < 50; ++i) {
      EXPECT_NEAR(samples[2 * i], sample_at(static_cast<double>(i), 0), 1e-6);
      EXPECT_NEAR(samples[2 * i + 1], sample_at(static_cast<double>(i), 1), 1e-6);
    }
  }
}

TEST_F(SoundFile, TakesFramesBetweenItsOwnLinearlyAtAnySpeedAndRate) {
  PlayedSound sound = played(1, 1000);
  sound.play(0, 1.7);
  const double rate = 12345;
  const auto samples = heard(sound, 0.003, rate, 300);
  for (std::size_t i = 0; i < 300; ++i) {
    const double frame = (0.003 + static_cast<double>(i) / rate) * 1.7 * kRate;
    EXPECT_NEAR(samples[2 * i], frame > 999 ? 0 : sample_at(frame, 0), 1e-6) << i;
  }
}

TEST_F(SoundFile, StartedOftenIsTheSumAndOfTooManyTheOldestEnds) {
  PlayedSound sound = played(1, 100);
  for (int i = 0; i < 40; ++i) sound.play(0, 1);
  EXPECT_NEAR(heard(sound, 10.0 / kRate, kRate, 1)[0], 32 * sample_at(10, 0), 1e-5);
  sound.play(5, 1);  // the others have ended
  EXPECT_NEAR(heard(sound, 5 + 10.0 / kRate, kRate, 1)[0], sample_at(10, 0), 1e-6);
  sound.stop();
  EXPECT_FALSE(sound.sounds_at(5));
}

TEST_F(SoundFile, GoesThroughAnImage) {
  PlayedSound sound = played(2, 100), other(std::pmr::get_default_resource());
  sound.play(0.25, 0.5);
  ByteWriter out;
  sound.save(out);
  ByteReader in(out.bytes().data(), out.bytes().size());
  other.load(in);
  EXPECT_EQ(heard(sound, 0.25, kRate, 100), heard(other, 0.25, kRate, 100));
  Hasher one, two;
  sound.hash(one);
  other.hash(two);
  EXPECT_EQ(one.value(), two.value());
  for (std::size_t size = 0; size < out.bytes().size(); ++size) {
    ByteReader cut(out.bytes().data(), size);
    EXPECT_THROW(other.load(cut), Error) << size;
  }
}

TEST_F(SoundFile, ThatIsCutOffOrDamagedIsAnErrorThatNamesIt) {
  const std::string whole = wav(2, 200);
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    try {
      (void)Samples::parse(std::string_view(whole).substr(0, size), "cut.wav");
      ADD_FAILURE() << size << " bytes were read as a sound";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::File);
      EXPECT_NE(std::string(error.what()).find("cut.wav"), std::string::npos);
    }
  }
  std::mt19937 random(1);
  for (int round = 0; round < 5000; ++round) {
    std::string bytes = whole.substr(0, round % 3 == 0 ? whole.size() : 44 + random() % 100);
    for (int i = 0; i < 4; ++i) bytes[random() % std::min<std::size_t>(bytes.size(), 60)] = static_cast<char>(random());
    try {
      const Samples samples = Samples::parse(bytes, "x");
      EXPECT_LE(samples.frames(), 100'000U);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::File);
    }
  }
}

TEST(Tone, ThatIsDamagedInAnImageIsRefused) {
  SineTone tone, other;
  tone.set_frequency(0.1, 440);
  tone.set_volume(0.5);
  ByteWriter out;
  tone.save(out);
  for (std::size_t field = 0; field < 5; ++field) {
    auto bytes = out.bytes();
    const double wrong = std::nan("");
    std::memcpy(bytes.data() + field * sizeof wrong, &wrong, sizeof wrong);
    ByteReader in(bytes.data(), bytes.size());
    EXPECT_THROW(other.load(in), Error) << field;
  }
  ByteReader in(out.bytes().data(), out.bytes().size());
  other.load(in);
  EXPECT_EQ(heard(tone, 0.1, kRate, 100), heard(other, 0.1, kRate, 100));
}

// --- targets of requests ---------------------------------------------------------------------------------------------

using Kind = RequestTarget::Kind;

TEST(RequestTarget, IsAPageAFileOrAMethod) {
  EXPECT_EQ(parse_request_target("/").kind, Kind::Start);
  EXPECT_EQ(parse_request_target("/?x=1").kind, Kind::Start);
  const auto page = parse_request_target("/walk/my%20map.html?zoom=2");
  EXPECT_EQ(page.kind, Kind::Page);
  EXPECT_EQ(page.name, "walk/my map.html");
  const auto method = parse_request_target("/set-speed_3.5_a%5Fb_");
  EXPECT_EQ(method.kind, Kind::Method);
  EXPECT_EQ(method.name, "set-speed");
  EXPECT_EQ(method.arguments, (std::vector<std::string>{"3.5", "a_b", ""}));
}

TEST(RequestTarget, ThatLeadsElsewhereIsInvalid) {
  for (const char* target : {"",
                             "x",
                             "http://x/",
                             "//x.html",
                             "/../x.html",
                             "/a/../x.html",
                             "/%2e%2e/x.html",
                             "/a/%2E%2E%2fx.html",
                             "/.hidden.html",
                             "/a//x.html",
                             "/a\\x.html",
                             "/c:x.html",
                             "/x%00.html",
                             "/x%0a.html",
                             "/%",
                             "/%4",
                             "/%zz",
                             "/a/b",
                             "/_",
                             "/a b",
                             "/x%00_1",
                             "/\xff",
                             "/a+b"})
    EXPECT_EQ(parse_request_target(target).kind, Kind::Invalid) << target;
  EXPECT_EQ(parse_request_target("/" + std::string(9000, 'a')).kind, Kind::Invalid);
  std::string many = "/m";
  for (int i = 0; i < 33; ++i) many += "_1";
  EXPECT_EQ(parse_request_target(many).kind, Kind::Invalid);
}

TEST(RequestTarget, OfAnyBytesNeverLeadsOut) {
  constexpr std::string_view kParts[] = {"/", ".", "..", "%2e", "%2F", "%00", "%",   "_",  ".html", "a",
                                         "-", "?", "#",  "\\",  ":",   "\n",  "%5f", "A9", " ",     "\x80"};
  std::mt19937 random(7);
  int pages = 0, methods = 0;
  for (int round = 0; round < 100'000; ++round) {
    std::string target = random() % 10 == 0 ? "" : "/";
    for (auto left = random() % 10; left > 0; --left) target += kParts[random() % std::size(kParts)];
    const RequestTarget parsed = parse_request_target(target);
    pages += parsed.kind == Kind::Page;
    methods += parsed.kind == Kind::Method;
    if (parsed.kind == Kind::Page) {
      EXPECT_TRUE(parsed.name.ends_with(".html")) << target;
      EXPECT_EQ(("/" + parsed.name).find("/."), std::string::npos) << target;
      EXPECT_EQ(("/" + parsed.name).find("//"), std::string::npos) << target;
    }
    if (parsed.kind == Kind::Method) {
      EXPECT_FALSE(parsed.name.empty());
      EXPECT_EQ(parsed.name.find_first_of("/.%_ \\:\n"), std::string::npos) << target;
    }
    for (const std::string& text : parsed.arguments)
      for (const char c : text) EXPECT_TRUE(static_cast<unsigned char>(c) >= ' ') << target;
  }
  EXPECT_GT(pages, 100);
  EXPECT_GT(methods, 1000);
}

}  // namespace
}  // namespace breve
