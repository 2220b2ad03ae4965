termesh 1
