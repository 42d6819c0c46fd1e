// The effects.
constexpr const char* effects[][2] = {
    {"motion", "a body has a velocity"},
    {"levitation", "a body is lighter than air"},
};
