// One line about each function of the language. A test checks that none is left out.
#include <algorithm>
#include <iterator>

#include "steve/analysis/signatures.hpp"

namespace breve::steve {

namespace {

constexpr FunctionNote kNotes[] = {
    {"sin", "angle", "Sine of an angle in radians."},
    {"cos", "angle", "Cosine of an angle in radians."},
    {"tan", "angle", "Tangent of an angle in radians."},
    {"asin", "x", "The angle in radians, -pi/2 to pi/2, whose sine is x."},
    {"acos", "x", "The angle in radians, 0 to pi, whose cosine is x."},
    {"atan", "x", "The angle in radians, -pi/2 to pi/2, whose tangent is x."},
    {"atan2", "y x", "The angle in radians, -pi to pi, of the point (x, y) as seen from the origin."},
    {"atan2", "x", "The same as atan, with a warning: for all four quadrants write atan2(y, x)."},
    {"sqrt", "x", "Square root; nan for a negative number, with a warning."},
    {"exp", "x", "e to the power of x."},
    {"log", "x", "Natural logarithm; not finite for numbers that are not above 0, with a warning."},
    {"abs", "x", "Magnitude, always as a float; |n| keeps an int an int."},
    {"min", "a b", "The lesser of two numbers, always as a float."},
    {"max", "a b", "The greater of two numbers, always as a float."},
    {"floor", "x", "The greatest whole number that is not above x, as a float."},
    {"ceil", "x", "The least whole number that is not below x, as a float."},
    {"round", "x", "The nearest whole number, as a float; halves are rounded away from zero."},
    {"pow", "x y", "x to the power of y; (x ^ y) has the precedence of a product."},
    {"format", "x decimals", "The number as text with this many decimals, 0 to 100."},
    {"isnan", "x", "1 if x is not a number (for example the result of 0.0/0.0), else 0."},
    {"isinf", "x", "1 if x is infinite, else 0."},
    {"dot", "a b", "Scalar product of two vectors."},
    {"cross", "a b", "Vector product, right-handed."},
    {"angle", "a b", "Angle between two vectors, 0 to pi; nan, with a warning, if one has no length."},
    {"transpose", "m", "The matrix with rows and columns exchanged."},
    {"rotationMatrix", "axis radians", "The matrix that rotates about an axis of unit length, counter-clockwise."},
    {"stddev", "numbers", "Standard deviation of a sample: a list of numbers, divided by their count less 1."},
    {"randomGauss", "", "A random number, normally distributed with mean 0 and deviation 1."},
    {"randomExponential", "", "A random number, exponentially distributed with mean 1."},
    {"randomGamma", "order", "A random number, gamma-distributed; the order is 1 or more."},
    {"randomSeed", "seed", "Restart the world's random numbers from a seed."},
    {"randomSeedFromDevRandom", "",
     "Start the world's random numbers from a seed that differs each time; yields it, or -1."},
    {"RGBtoHSV", "rgb",
     "Red, green, blue (0 to 1) as hue (degrees), saturation and value (0 to 1); a grey has hue -1."},
    {"HSVtoRGB", "hsv", "Hue (degrees), saturation and value (0 to 1) as red, green, blue (0 to 1)."},
    {"uniqueColor", "number", "Colour number n of a sequence of colours that are easy to tell apart."},
    {"typeof", "value",
     "The name of the value's type: int, double, vector, matrix, string, object, list, hash, pointer, "
     "data or NULL."},
    {"isa", "className", "1 if the calling object's class or an ancestor has that name or alias, else 0."},
    {"objectName", "instance", "The name of an object's class."},
    {"respondsTo", "instance methodName", "1 if the object has a method of that name, with any keywords, else 0."},
    {"getController", "", "The controller of the simulation."},
    {"newInstanceForClassString", "className", "A new object of the class of that name, which must exist."},
    {"callMethodNamed", "instance methodName arguments",
     "Call the method with as many keywords as the list has elements, in their order."},
    {"keys", "table", "A list of the keys of a hash, in order of insertion."},
    {"hasKey", "table key", "1 if the hash has that key, else 0."},
    {"addObserver", "announcer notification methodName",
     "Call the method of the calling object whenever the announcer announces that; 0, or -1 on failure."},
    {"removeObserver", "announcer notification", "Undo addObserver."},
    {"notify", "notification", "Announce something from the calling object to its observers, at once."},
    {"addCollisionHandler", "instance className methodName",
     "Call the method when an object of the instance's class touches one of that class."},
    {"setGC", "automatic", "1: free the calling object as soon as nothing refers to it. 0: keep it until it is freed."},
    {"getRetainCount", "", "The number of references to the calling object; for inspection only."},
    {"addDependency", "instance", "Obsolete: see add-dependency of Object."},
    {"removeDependency", "instance", "Obsolete: see remove-dependency of Object."},
    {"setFreedInstanceProtection", "on", "Obsolete: freed objects are always protected."},
    {"objectAllocationReport", "", "Print the number of live objects of each class."},
    {"getTime", "", "Simulated seconds since the start."},
    {"getRealTime", "", "Seconds since the beginning of 1970, of the machine's clock."},
    {"getRunningTime", "", "Seconds of the machine's clock since the start of the run."},
    {"addEvent", "methodName time interval",
     "Call the calling object's method at a simulated time, and then every `interval` seconds; 0: once."},
    {"removeEvent", "methodName time", "Drop queued calls of the method at that time."},
    {"endSimulation", "", "End the simulation after the current iteration."},
    {"pauseSimulation", "", "Pause the simulation, if the host can."},
    {"unpauseSimulation", "", "Continue after a pause."},
    {"sleep", "seconds", "Do nothing for some seconds of the machine's clock."},
    {"system", "command", "Run a shell command, if the host allows it; yields what it printed."},
    {"getArgc", "", "The number of arguments of the program, including its own file."},
    {"getArgv", "index", "An argument of the program; number 0 is its own file."},
    {"findFile", "name", "The full path of a file on the search path, or an empty string."},
    {"stacktrace", "", "Print the call chain that led here."},
    {"getMouseX", "", "Horizontal position of the mouse, from the left; 0 without a window."},
    {"getMouseY", "", "Vertical position of the mouse, from the top; 0 without a window."},
    {"getAllPressedKeys", "", "The recently pressed keys; empty without a window."},
    {"playSound", "", "Beep, if the host can."},
    {"dialogBox", "title message yes no", "Ask the user: 1 for yes, 0 for no or if no user can be asked."},
    {"openFileForReading", "name", "Open a text file; null if that fails."},
    {"openFileForWriting", "name", "Open a text file and empty it; null if that fails."},
    {"openFileForAppending", "name", "Open a text file for appending; null if that fails."},
    {"readLine", "file", "The next line, without its line end."},
    {"readFileAsString", "file", "The rest of the file."},
    {"readDelimitedList", "file delimiters", "The next line as a list of strings, split at any of those characters."},
    {"readWhitespaceDelimitedList", "file", "The next line as a list of strings, split at spaces."},
    {"writeString", "file text", "Write text unchanged."},
    {"fileEOF", "file", "1 if a read has reached the end of the file, else 0."},
    {"closeFile", "file", "Close the file."},
    {"createUserSensor",
     "name rows columns range angle distances atDistance byDistance azimuths atAzimuth byAzimuth incidences "
     "atIncidence "
     "byIncidence",
     "Define a type of infrared sensor, in place of an earlier one of that name: rows x columns rays about its z axis, "
     "up "
     "to the angle (radians) and the range (length units), and three tables of factors, each a count, the values in "
     "ascending order and their factors: by distance along the axis, by azimuth and by incidence (radians)."},
};

std::size_t count_words(std::string_view words) {
  if (words.empty()) return 0;
  return 1 + static_cast<std::size_t>(std::count(words.begin(), words.end(), ' '));
}

}  // namespace

const FunctionNote* function_note(std::string_view name, std::size_t parameters) {
  const auto found = std::find_if(std::begin(kNotes), std::end(kNotes), [&](const FunctionNote& note) {
    return note.name == name && count_words(note.parameters) == parameters;
  });
  return found == std::end(kNotes) ? nullptr : &*found;
}

}  // namespace breve::steve
