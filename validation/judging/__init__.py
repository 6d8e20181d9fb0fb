"""What `reproduce` and `stability` share: a row and its verdict, how it is said and drawn, and the runs it rests on."""
