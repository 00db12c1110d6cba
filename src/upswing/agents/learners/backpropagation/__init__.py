"""Networks stepped in compiled code, one sample at a time: what the learners that are networks share."""
