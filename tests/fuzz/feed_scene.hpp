// The program that fuzz_feed gives its inputs to, and valid documents.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace breve::fuzz {

inline constexpr std::string_view kFeedScene = R"steve(@use Control.
@use Mobile.
@use Stationary.
@use Shape.
@use Link.
@use MultiBody.
@use Push.
@use SFFNetwork.
@use CMAEvolutionStrategy.
@use MultiObjectiveSearch.
@use DirectedGraph.
@use Terrain.
@use Sound.
@use Image.
@use NetworkServer.
Controller Feed.
Object : Tree {
  + variables:
    i (int).
    d (float).
    v (vector).
    m (matrix).
    s (string).
    k (list).
    h (hash).
    b (data).
    friend (object).
    a (3 floats).
  + to fill:
    i = 7. d = .5. v = (1, 2, 3). m = [ (1, 0, 0), (0, 1, 0), (0, 0, 1) ]. s = "a <b> & c".
    k = { 1, 2.5, "x", { (1, 1, 1) } }.
    push k onto k.
    h{"key"} = 3.
    h{4} = k.
    a[1] = 2.5.
    friend = new Tree.
    self add-dependency on friend.
}
Mobile : Ball {
  + to init:
    self set-shape to ((new Sphere) init-with radius .5).
    self move to (1, 2, 3).
    self enable-physics.
    self handle-collisions with-type "Stationary" with-method "hit".
  + to hit on other (object):
    return.
}
MultiBody : Creature {
  + to init:
    root, arm (object).
    joint (object).
    root = new Link.
    root set-shape to ((new Cube) init-with size (1, 1, 1)).
    arm = new Link.
    arm set-shape to ((new Cube) init-with size (1, .2, .2)).
    joint = new RevoluteJoint.
    joint link parent root to-child arm with-normal (0, 0, 1) with-parent-point (.5, 0, 0) with-child-point (-.5, 0, 0).
    joint set-double-spring with-strength 10 with-max 1.0 with-min -1.0.
    self register with-link root.
}
Control : Feed {
  + variables:
    server, sound, interpreter, code (object).
    calls (int).
  + to init:
    server = new NetworkServer.
    server listen on-port 0.
    interpreter = new PushInterpreter.
    interpreter set-evaluation-limit to 200.
    code = new PushProgram.
  + to make named name (string):
    x (object).
    if name == "Network": {
      x = new NeuralNetwork.
      x add-feed-forward-layer with-neuron-count 2.
      x add-elman-layer with-neuron-count 2.
    } else if name == "Search": {
      x = new CMAEvolutionStrategy.
      x begin at { 0, 1 } with-step .5.
    } else if name == "Fronts": {
      x = new MultiObjectiveSearch.
      x begin from { 0, 1 } to { 1, 2 } with-objectives 2 with-population 4.
      x ask.
      x tell values { { 1, 2 }, { 2, 1 }, { 1, 1 }, { 2, 2 } }.
    } else if name == "Program": {
      x = new PushProgram.
      x parse program "( 1 2 INTEGER.+ ( 1.5 TRUE CODE.QUOTE ( X ) ) )".
    } else if name == "Picture": x = ((new Image) init-with width 3 height 2).
    else x = newInstanceForClassString(name).
    if name == "Tree": x fill.
    return (x archive-as-xml-string).
  + to take-archive from text (string):
    return (self parse-xml-network-request from-string text).
  + to take-archive-file:
    return (self dearchive-xml file "archive.xml").
  + to take-configuration from text (string):
    interpreter configure from-text text.
    code make-random-code with-interpreter interpreter.
    interpreter run program code for-steps 200.
    interpreter print-config.
  + to take-sound:
    sound = new Sound.
    sound load from-file "sound.wav".
    sound play with-speed 1.5.
    return (sound get-duration).
  + to add amount amount (int) and more (float):
    calls += amount.
    return "$amount $more".
  + to show:
    return "<b>$calls</b>".
  + to accept-upload of thing (object) from where (string):
    if thing: print (thing get-type), where.
    return thing.
}
)steve";

inline constexpr std::string_view kFeedClasses[] = {"Tree",   "Ball",    "Creature", "Network",         "Search",
                                                    "Fronts", "Program", "Picture",  "GADirectedGraph", "Terrain"};

inline constexpr std::string_view kConfigurations[] = {
    "MAX-RANDOM-FLOAT 10\nMIN-RANDOM-FLOAT -10\nMAX-POINTS-IN-PROGRAM 100\nEVALPUSH-LIMIT 150\ntype FLOAT\ntype "
    "INTEGER\n",
    "# a comment\ninstruction INTEGER.+\ninstruction CODE.DO*TIMES\ninstruction EXEC.Y\ninstruction FLOAT.ERC\n"
    "instruction NAME.ERC\nNEW-ERC-NAME-PROBABILITY 0.001\nTOP-LEVEL-PUSH-CODE FALSE\nTOP-LEVEL-POP-CODE TRUE\n",
    "MAX-RANDOM-INTEGER 2147483647\nMIN-RANDOM-INTEGER -2147483647\nMAX-POINTS-IN-RANDOM-EXPRESSIONS 25\ntype EXEC\n"
    "type CODE\ntype NAME\ntype VECTOR\ntype BOOLEAN\n"};

inline constexpr std::string_view kTargets[] = {
    "/add_3_0.5", "/show", "/", "/walk/map.html?x=1", "/add_%33_%2e5", "/end-simulation", "/%2e%2e/secret.html"};

inline constexpr std::string_view kWords[] = {"<",
                                              ">",
                                              "</",
                                              "&amp;",
                                              "&#0;",
                                              "&lt;",
                                              "\"",
                                              "'",
                                              "<!DOCTYPE a [<!ENTITY b \"c\">]>",
                                              "&b;",
                                              "<![CDATA[",
                                              "]]>",
                                              "<?xml",
                                              "-1",
                                              "4294967296",
                                              "1e309",
                                              "nan",
                                              "-inf",
                                              "99999999999999999999",
                                              "0.1",
                                              "\xff\xfe",
                                              "\xc3",
                                              "name=\"\"",
                                              "index=\"1\"",
                                              "type=\"list\"",
                                              "..",
                                              "%00",
                                              "%2F",
                                              "_",
                                              "__",
                                              "instruction ",
                                              "type ",
                                              "RIFF",
                                              "data",
                                              "fmt ",
                                              "FORM",
                                              ".snd",
                                              "\n",
                                              " ",
                                              "TRUE"};

/// The head of a WAV, AIFF or AU file and some samples. Numbers are written with the first byte first or last.
inline std::string sound_document(std::size_t kind) {
  constexpr std::uint32_t kRate = 8000;
  std::string out, samples;
  for (int i = 0; i < 200; ++i) samples += static_cast<char>((i * 37) % 256);
  const auto put = [&](std::uint32_t number, int bytes, bool little) {
    for (int i = 0; i < bytes; ++i) out += static_cast<char>(number >> 8 * (little ? i : bytes - 1 - i) & 255);
  };
  const auto size = static_cast<std::uint32_t>(samples.size());
  if (kind < 5) {  // WAV: whole numbers of 16 and 8 bits, mu-law, IMA ADPCM, numbers of 32 bits
    constexpr struct {
      std::uint32_t format, channels, bits, align;
    } kKinds[] = {{1, 2, 16, 4}, {1, 1, 8, 1}, {7, 1, 8, 1}, {17, 1, 4, 40}, {3, 1, 32, 4}};
    const auto& [format, channels, bits, align] = kKinds[kind];
    const bool packed = format == 17;
    out = "RIFF";
    put(36 + (packed ? 4 : 0) + size, 4, true);
    out += "WAVEfmt ";
    put(packed ? 20 : 16, 4, true);
    put(format, 2, true);
    put(channels, 2, true);
    put(kRate, 4, true);
    put(kRate * align, 4, true);
    put(align, 2, true);
    put(bits, 2, true);
    if (packed) {
      put(2, 2, true);
      put(73, 2, true);  // samples of a block of 40 bytes
    }
    out += "data";
    put(size, 4, true);
    return out + samples;
  }
  if (kind == 5) {
    out = "FORM";
    put(46 + size, 4, false);
    out += "AIFFCOMM";
    put(18, 4, false);
    put(1, 2, false);
    put(size / 2, 4, false);
    put(16, 2, false);
    out += std::string("\x40\x0b\xfa\x00\x00\x00\x00\x00\x00\x00", 10);  // 8000 as a number of 80 bits
    out += "SSND";
    put(8 + size, 4, false);
    put(0, 4, false);
    put(0, 4, false);
    return out + samples;
  }
  out = ".snd";
  for (const std::uint32_t number : {24U, size, 3U, kRate, 1U}) put(number, 4, false);
  return out + samples;
}
inline constexpr std::size_t kSoundDocuments = 7;

}  // namespace breve::fuzz
