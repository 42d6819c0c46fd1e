// breve.h is complete in itself as C++11.
#include "breve/breve.h"

int breve_header_alone_in_cpp();
int breve_header_alone_in_cpp() { return BREVE_ABI; }
