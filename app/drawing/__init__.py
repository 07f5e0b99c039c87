"""A design as it is drawn: yarn, colours and solids, without a viewer."""
