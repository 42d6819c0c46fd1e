// Another file of a name that the house has already.
#pragma once
