/* A player who always does the same, for tests: keys and clicks at certain frames, and pictures. */
#ifndef ROBOT_H
#define ROBOT_H

#include "meadow.h"

/* Queues what a hand would do before this frame, as events of SDL. */
void robot_play(int frame, int window_width, int window_height);

/* After a frame: reports to standard output. False: the game has been played to its end. */
bool robot_watch(meadow* m, int frame);

/* Should this frame be drawn, and its picture be kept? The others are not drawn, so that a test is quick. */
const char* robot_picture(int frame);

#endif
