// Lines of text become SDL's events.
#include "viewer_play.hpp"

#include <SDL.h>
#include <fmt/format.h>

#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

namespace breve::command {

namespace {

void push_key(SDL_Keycode key, bool down) {
  SDL_Event event{};
  event.type = down ? SDL_KEYDOWN : SDL_KEYUP;
  event.key.state = down ? SDL_PRESSED : SDL_RELEASED;
  event.key.keysym.sym = key;
  SDL_PushEvent(&event);
}

void push_button(int x, int y, bool down, std::uint8_t button) {
  SDL_Event event{};
  event.type = down ? SDL_MOUSEBUTTONDOWN : SDL_MOUSEBUTTONUP;
  event.button.state = down ? SDL_PRESSED : SDL_RELEASED;
  event.button.button = button;
  event.button.x = x;
  event.button.y = y;
  SDL_PushEvent(&event);
}

void push_motion(int x, int y, int from_x, int from_y) {
  SDL_Event event{};
  event.type = SDL_MOUSEMOTION;
  event.motion.x = x;
  event.motion.y = y;
  event.motion.xrel = x - from_x;
  event.motion.yrel = y - from_y;
  SDL_PushEvent(&event);
}

void push_wheel(int steps) {
  SDL_Event event{};
  event.type = SDL_MOUSEWHEEL;
  event.wheel.y = steps;
  event.wheel.preciseY = static_cast<float>(steps);
  SDL_PushEvent(&event);
}

// How many arguments each action has; -1: any number.
const std::map<std::string, int> kActions{{"key", 1},  {"click", 2}, {"drag", 5}, {"wheel", 1}, {"shot", 1},
                                          {"say", -1}, {"quit", 0},  {"read", 0}, {"resize", 2}};

}  // namespace

Play::Play(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(fmt::format("--play: cannot read '{}'", file));
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    std::istringstream words(line);
    PlayedAction one;
    if (line.empty() || line.front() == '#') continue;
    words >> one.frame >> one.action;
    for (std::string word; words >> word;) one.arguments.push_back(word);
    const auto known = kActions.find(one.action);
    if (known == kActions.end() || (known->second >= 0 && static_cast<int>(one.arguments.size()) != known->second) ||
        (one.action == "key" && SDL_GetKeyFromName(one.arguments[0].c_str()) == SDLK_UNKNOWN))
      throw std::runtime_error(fmt::format("{}:{}: '{}' is not an action of --play", file, number, line));
    actions_.push_back(one);
  }
}

std::vector<PlayedAction> Play::begin_frame(int frame) const {
  std::vector<PlayedAction> others;
  const auto number = [](const std::string& text) { return std::atoi(text.c_str()); };
  for (const PlayedAction& one : actions_) {
    if (one.frame != frame) continue;
    const auto& given = one.arguments;
    if (one.action == "key") {
      push_key(SDL_GetKeyFromName(given[0].c_str()), true);
      push_key(SDL_GetKeyFromName(given[0].c_str()), false);
    } else if (one.action == "click") {
      push_button(number(given[0]), number(given[1]), true, SDL_BUTTON_LEFT);
      push_button(number(given[0]), number(given[1]), false, SDL_BUTTON_LEFT);
    } else if (one.action == "drag") {
      const std::uint8_t button = given[4] == "right" ? SDL_BUTTON_RIGHT : SDL_BUTTON_LEFT;
      push_button(number(given[0]), number(given[1]), true, button);
      push_motion(number(given[2]), number(given[3]), number(given[0]), number(given[1]));
      push_button(number(given[2]), number(given[3]), false, button);
    } else if (one.action == "wheel") {
      push_wheel(number(given[0]));
    } else {
      others.push_back(one);
    }
  }
  return others;
}

}  // namespace breve::command
